//! Vessels and the points on them in words.

use super::motions::motion_in_words;
use super::significant;
use crate::scene::check::number;
use crate::scene::{AngleOrder, Scene, Vessel};

/// "platform: moved by the host, its origin at (0, 0, 0) m, carries fairlead1 and fairlead2; in `run` it stays where it is".
pub(super) fn vessel_in_words(scene: &Scene, vessel: &Vessel) -> String {
    let [x, y, z] = vessel.position.map(number);
    let mut said = format!(
        "{}: moved by the host, its origin at ({x}, {y}, {z}) m",
        vessel.name
    );
    if vessel.attitude != [0.0; 3] {
        let [roll, pitch, yaw] = vessel.attitude.map(significant);
        said.push_str(&format!(", at roll {roll} rad, pitch {pitch} rad, yaw {yaw} rad"));
    }
    let points = scene.points.iter();
    let aboard = points.filter(|point| point.on.as_ref() == Some(&vessel.name));
    let names: Vec<&str> = aboard.map(|point| point.name.as_str()).collect();
    let carried = if names.is_empty() {
        "no point".to_string()
    } else {
        names.join(", ")
    };
    let motion = scene.motion.get(&vessel.name).map(motion_in_words);
    let motion = motion.unwrap_or_else(|| "stays where it is".to_string());
    let angles = match vessel.motion_angles {
        AngleOrder::Zyx => "",
        AngleOrder::Xyz => {
            "; roll, pitch and yaw of a motion in `run` turn it by Rx(roll)·Ry(pitch)·Rz(yaw), as in MoorDyn, those of the FMU by \
             Rz(yaw)·Ry(pitch)·Rx(roll)"
        }
    };
    format!("{said}, carries {carried}; in `run` it {motion}{angles}")
}
