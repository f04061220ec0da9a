//! `moorline convert`: a deck of another program as a scene.

use std::io::Write;
use std::path::Path;

use moorline::model::Model;
use moorline::output::{check_file, write_file};
use moorline::scene::{Supplement, TOML, load_with};

use super::failure::Failure;
use super::print;

/// Reads a deck with what it leaves to its host, and writes the same system as a scene with comments.
pub fn convert(path: &Path, target: &Path, supplement: &Supplement) -> Result<(), Failure> {
    check_file(target)?;
    let loaded = load_with(path, supplement)?;
    if loaded.format == TOML {
        let text = format!("{} is a scene of moorline already", path.display());
        return Err(Failure::Argument(text));
    }
    // A scene that cannot be made discrete is none.
    Model::new(&loaded.scene).map_err(|mistake| Failure::of_scene(mistake, &loaded))?;
    let text = loaded.to_commented_toml();
    write_file(target, |out: &mut dyn Write| out.write_all(text.as_bytes()))?;
    let mut said = format!("written to {}\n", target.display());
    for note in &loaded.notes {
        said.push_str(&format!("note: {note}\n"));
    }
    print(&said)
}

/// Reads `NAME=X,Y,Z`: a vessel and its reference position [m].
pub fn placed_vessel(text: &str) -> Result<(String, [f64; 3]), String> {
    let wanted = "must be NAME=X,Y,Z in metres";
    let (name, position) = text.split_once('=').ok_or(wanted)?;
    let numbers: Vec<f64> = position
        .split(',')
        .map(|part| {
            part.trim()
                .parse::<f64>()
                .ok()
                .filter(|number| number.is_finite())
        })
        .collect::<Option<_>>()
        .ok_or(wanted)?;
    let position = numbers.try_into().map_err(|_| wanted)?;
    Ok((name.trim().to_string(), position))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_vessel_is_placed_by_name_and_three_numbers() {
        let placed = placed_vessel("turbine2=1600,0,-0.5");
        assert_eq!(placed, Ok(("turbine2".to_string(), [1600.0, 0.0, -0.5])));
        for wrong in [
            "turbine2",
            "turbine2=1,2",
            "a=1,2,3,4",
            "a=1,2,x",
            "a=1,2,nan",
            "",
        ] {
            assert!(placed_vessel(wrong).is_err(), "{wrong}");
        }
    }
}
