//! The known name nearest to an unknown one.

use super::keys;

/// Returns the known name that the user may have meant: a key that has this name in other programs, otherwise the most similar name.
pub fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str> + Clone) -> Option<&'a str> {
    let lower = name.to_lowercase();
    let spelled = |candidate: &&str| {
        let mut keys = keys::tables().into_iter().flat_map(|table| table.keys);
        keys.any(|key| key.name() == *candidate && key.rule.spellings.contains(&lower.as_str()))
    };
    known.clone().into_iter().find(spelled).or_else(|| {
        known
            .into_iter()
            .map(|candidate| (closeness(&lower, &candidate.to_lowercase()), candidate))
            .filter(|(closeness, _)| *closeness >= 0.6)
            .max_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, candidate)| candidate)
    })
}

/// Similarity of two names, 1 if they are equal; a name that begins with the other counts as close.
fn closeness(name: &str, candidate: &str) -> f64 {
    let (short, long) = if name.len() < candidate.len() {
        (name, candidate)
    } else {
        (candidate, name)
    };
    if short.len() >= 3 && long.starts_with(short) {
        return 0.9;
    }
    strsim::normalized_damerau_levenshtein(name, candidate)
}

/// ", did you mean `x`?" or nothing, then the known names in brackets.
pub fn suggestion<'a>(name: &str, what: &str, known: impl IntoIterator<Item = &'a str> + Clone) -> String {
    let meant = nearest(name, known.clone())
        .map(|name| format!(", did you mean `{name}`?"))
        .unwrap_or_default();
    let list: Vec<&str> = known.into_iter().collect();
    if list.is_empty() {
        return format!("{meant} (there are no {what})");
    }
    let shown = list[..list.len().min(20)].join(", ");
    let more = if list.len() > 20 { ", …" } else { "" };
    format!("{meant} ({what}: {shown}{more})")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_of_the_finger_finds_the_key() {
        let known = ["diameter", "mass", "axial_stiffness"];
        assert_eq!(nearest("diamter", known), Some("diameter"));
        assert_eq!(nearest("EA", known), Some("axial_stiffness"));
        assert_eq!(nearest("Mass", known), Some("mass"));
        assert_eq!(nearest("colour", known), None);
    }
}
