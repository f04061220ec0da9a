//! Places of the parts of a scene in a file that is not TOML.

use std::collections::BTreeMap;
use std::ops::Range;

use super::{Note, SceneError, path};

/// Places of parts of a scene, by key path.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Places {
    places: BTreeMap<String, Place>,
}

#[derive(Debug, Clone, PartialEq)]
struct Place {
    span: Range<usize>,
    /// Name in the file.
    words: String,
}

impl Places {
    /// Records the origin of a key path in the file, and its name there.
    pub fn put(&mut self, at: impl Into<String>, span: &Range<usize>, words: impl Into<String>) {
        let place = Place {
            span: span.clone(),
            words: words.into(),
        };
        self.places.insert(at.into(), place);
    }

    /// Place of a key path, or of the innermost part that contains it.
    fn find(&self, at: &str) -> Option<&Place> {
        let mut at = at;
        while !at.is_empty() {
            if let Some(place) = self.places.get(at) {
                return Some(place);
            }
            at = &at[..at.rfind(['.', '[']).unwrap_or(0)];
        }
        None
    }

    /// Converts a mistake in the scene to one in the file.
    pub fn locate(&self, mut mistake: SceneError) -> SceneError {
        if mistake.span.is_none() {
            let place = self.find(&mistake.at);
            mistake.span = Some(place.map_or(0..0, |place| place.span.clone()));
            if let Some(place) = place {
                mistake.at = place.words.clone();
            }
        }
        mistake
    }

    /// Converts a remark on the scene to one on a line of the file.
    pub fn locate_note(&self, source: &str, mut note: Note) -> Note {
        if let Some(place) = self.find(&note.at) {
            let (line, _) = path::line_column(source, place.span.start);
            note.at = format!("file line {line}, {}", place.words);
        }
        note
    }

    /// Line of the file [-], from 1, that a key path comes from.
    pub(super) fn line(&self, source: &str, at: &str) -> Option<usize> {
        let place = self.places.get(at)?;
        Some(path::line_column(source, place.span.start).0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_has_no_place_of_its_own_stands_where_its_holder_does() {
        let mut places = Places::default();
        places.put("points[0]", &(4..5), "point 1");
        places.put("points[0].position[2]", &(6..7), "point 1, Z");
        let located = |at: &str| places.locate(SceneError::new(at, "wrong"));
        assert_eq!(located("points[0].position[2]").to_string(), "point 1, Z: wrong");
        assert_eq!(located("points[0].mass").span, Some(4..5));
        assert_eq!(located("points[1].mass").to_string(), "points[1].mass: wrong");
    }
}
