//! Static equilibrium as JSON: the output of `moorline statics --json`, as described in `docs/json.md`:
//!
#![doc = include_str!("../../docs/json.md")]

use serde::Serialize;

pub use crate::simulation::ProfileNode;

/// A static equilibrium.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Statics {
    /// Title of the scene.
    pub title: String,
    /// Lines in the order of the scene.
    pub lines: Vec<Line>,
    /// Points in the order of the scene.
    pub points: Vec<Point>,
    /// Vessels in the order of the scene.
    pub vessels: Vec<Vessel>,
}

/// A line in equilibrium.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Line {
    /// Name of the line.
    pub name: String,
    /// End A, the anchor.
    pub end_a: End,
    /// End B, the fairlead.
    pub end_b: End,
    /// Horizontal part of the force at end B [N].
    pub horizontal: f64,
    /// Vertical part of the force at end B, positive downwards [N].
    pub vertical: f64,
    /// Unstretched length on the seabed [m].
    pub laid_length: f64,
    /// Stretched length [m].
    pub stretched_length: f64,
    /// Greatest vertical distance below the chord [m].
    pub sag: f64,
    /// Closed form of the line, if it has one.
    pub catenary: Option<Catenary>,
    /// Nodes from end A to end B.
    pub profile: Vec<ProfileNode>,
}

/// A closed-form catenary.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Catenary {
    /// Axial tension at end A [N].
    pub tension_a: f64,
    /// Axial tension at end B [N].
    pub tension_b: f64,
    /// Horizontal part of the force at end B [N].
    pub horizontal: f64,
    /// Vertical part of the force at end B, positive downwards [N].
    pub vertical: f64,
    /// Unstretched length on the seabed [m].
    pub laid_length: f64,
    /// Greatest vertical distance below the chord [m].
    pub sag: f64,
}

/// An end of a line.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct End {
    /// Force of the line on the support of this end [N].
    pub force: [f64; 3],
    /// Magnitude of this force [N].
    pub tension: f64,
}

/// A point in equilibrium.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Point {
    /// Name of the point.
    pub name: String,
    /// Kind of the point, as spelled in the scene.
    pub kind: &'static str,
    /// Position [m].
    pub position: [f64; 3],
    /// Force on the point [N] from all lines and, unless forces move the point, from its mass and load.
    pub force: [f64; 3],
}

/// A vessel in equilibrium.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Vessel {
    /// Name of the vessel.
    pub name: String,
    /// Stiffness from closed-form catenaries, if the lines have them.
    #[serde(flatten)]
    pub hold: Hold,
    /// Stiffness from the lines' elements.
    pub elements: Hold,
}

/// Stiffness of the mooring on a vessel.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Hold {
    /// Force [N] and moment [N m] of the mooring, about the vessel's origin.
    pub force: [f64; 6],
    /// Rows of the stiffness: minus the change of force [N/m, N] and moment [N, N m] with displacement and rotation.
    pub stiffness: Option<[[f64; 6]; 6]>,
}

/// Indented JSON of results, with a trailing newline.
pub fn text(results: &impl Serialize) -> String {
    serde_json::to_string_pretty(results).expect("results are numbers and names") + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulation::NodeBending;

    fn statics() -> Statics {
        let end = End {
            force: [1.0, 0.0, -2.0],
            tension: 5.0_f64.sqrt(),
        };
        let node = ProfileNode {
            s: 0.0,
            x: 0.1,
            y: 0.0,
            z: -1.0 / 3.0,
            tension: 1.0,
            bending: None,
        };
        Statics {
            title: "one".to_string(),
            lines: vec![Line {
                name: "line1".to_string(),
                end_a: end,
                end_b: end,
                horizontal: 1.0,
                vertical: 2.0,
                laid_length: 0.0,
                stretched_length: 10.0,
                sag: 0.5,
                catenary: None,
                profile: vec![node],
            }],
            points: vec![Point {
                name: "fairlead".to_string(),
                kind: "coupled",
                position: [0.0; 3],
                force: [1.0, 0.0, -2.0],
            }],
            vessels: vec![],
        }
    }

    fn keys(value: &serde_json::Value) -> Vec<&str> {
        value.as_object().unwrap().keys().map(String::as_str).collect()
    }

    #[test]
    fn the_keys_are_the_documented_ones() {
        let json: serde_json::Value = serde_json::from_str(&text(&statics())).unwrap();
        assert_eq!(keys(&json), ["lines", "points", "title", "vessels"]);
        let line = &json["lines"][0];
        let documented = [
            "catenary",
            "end_a",
            "end_b",
            "horizontal",
            "laid_length",
            "name",
            "profile",
            "sag",
            "stretched_length",
            "vertical",
        ];
        assert_eq!(keys(line), documented);
        assert_eq!(keys(&line["end_a"]), ["force", "tension"]);
        assert_eq!(keys(&line["profile"][0]), ["s", "tension", "x", "y", "z"]);
        assert_eq!(keys(&json["points"][0]), ["force", "kind", "name", "position"]);
        assert_eq!(json["vessels"], serde_json::json!([]));
    }

    #[test]
    fn a_line_that_bends_says_so_at_its_nodes() {
        let mut statics = statics();
        statics.lines[0].profile[0].bending = Some(NodeBending {
            curvature: 0.5,
            moment: 3.0,
        });
        let json: serde_json::Value = serde_json::from_str(&text(&statics)).unwrap();
        let node = &json["lines"][0]["profile"][0];
        assert_eq!(
            (node["curvature"].as_f64(), node["moment"].as_f64()),
            (Some(0.5), Some(3.0))
        );
    }

    #[test]
    fn every_number_reads_back_to_the_same_bits() {
        let json: serde_json::Value = serde_json::from_str(&text(&statics())).unwrap();
        assert_eq!(
            json["lines"][0]["end_a"]["tension"].as_f64(),
            Some(5.0_f64.sqrt())
        );
        assert_eq!(json["lines"][0]["profile"][0]["z"].as_f64(), Some(-1.0 / 3.0));
    }
}
