//! Units in the headers of tables in files.

use std::f64::consts::PI;

/// Quantity of a column of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Quantity {
    Time,
    Length,
    Angle,
    Speed,
    Mass,
    Force,
    Number,
}

/// Units accepted in the header of a table, with their values in SI units; the first of each quantity is the SI unit.
const HEADER_UNITS: &[(Quantity, &[&str], f64)] = &[
    (Quantity::Time, &["s", "sec", "seconds"], 1.0),
    (Quantity::Time, &["ms"], 1e-3),
    (Quantity::Time, &["min"], 60.0),
    (Quantity::Time, &["h"], 3600.0),
    (Quantity::Length, &["m"], 1.0),
    (Quantity::Length, &["mm"], 1e-3),
    (Quantity::Length, &["cm"], 1e-2),
    (Quantity::Length, &["km"], 1e3),
    (Quantity::Length, &["ft"], 0.3048),
    (Quantity::Length, &["in"], 0.0254),
    (Quantity::Angle, &["rad", "radians"], 1.0),
    (Quantity::Angle, &["deg", "degrees", "°"], PI / 180.0),
    (Quantity::Angle, &["mrad"], 1e-3),
    (Quantity::Speed, &["m/s"], 1.0),
    (Quantity::Speed, &["cm/s"], 1e-2),
    (Quantity::Speed, &["ft/s"], 0.3048),
    (Quantity::Mass, &["kg"], 1.0),
    (Quantity::Mass, &["g"], 1e-3),
    (Quantity::Mass, &["t"], 1e3),
    (Quantity::Force, &["N"], 1.0),
    (Quantity::Force, &["kN"], 1e3),
    (Quantity::Force, &["MN"], 1e6),
    (Quantity::Number, &["-", "1", "m/m"], 1.0),
    (Quantity::Number, &["%"], 1e-2),
];

impl Quantity {
    /// SI unit.
    pub(super) fn si(self) -> &'static str {
        self.units().next().map_or("-", |(names, _)| names[0])
    }

    fn units(self) -> impl Iterator<Item = (&'static [&'static str], f64)> {
        let units = HEADER_UNITS.iter().filter(move |(of, ..)| *of == self);
        units.map(|(_, names, factor)| (*names, *factor))
    }
}

/// Returns the value in SI units of a unit in a header, with or without brackets. Case matters only where it distinguishes units.
///
/// # Errors
/// The known units of the quantity.
pub(super) fn factor(text: &str, quantity: Quantity) -> Result<f64, String> {
    let unit = bare(text);
    let find = |same: &dyn Fn(&str) -> bool| {
        let mut units = quantity.units();
        units.find(|(names, _)| names.iter().any(|name| same(name)))
    };
    // mN and MN differ, and so do ms and Ms
    let loose = |name: &str| {
        let prefixed = name == "MN" || name == "ms" || name == "mm";
        !prefixed && name.to_lowercase() == unit.to_lowercase()
    };
    let found = find(&|name| name == unit).or_else(|| find(&loose));
    found.map(|(_, factor)| factor).ok_or_else(|| {
        let known: Vec<&str> = quantity.units().map(|(names, _)| names[0]).collect();
        format!(
            "unknown unit {}: one of {} would be right",
            super::rows::shown(unit),
            known.join(", ")
        )
    })
}

/// Returns the factor [-] that converts numbers in a unit of a heading to the unit of a key, such as 1000 from `kN` to `N`. For a key with a unit
/// that tables do not have, such as `kg/m`, only this unit is accepted.
///
/// # Errors
/// The units that would be right.
pub fn factor_to(si: &str, text: &str) -> Result<f64, String> {
    let quantity = HEADER_UNITS
        .iter()
        .find(|(_, names, factor)| *factor == 1.0 && names[0] == si);
    match quantity {
        Some((quantity, ..)) => factor(text, *quantity),
        None if bare(text) == si => Ok(1.0),
        None if si.contains(',') => Err(format!(
            "its numbers have different units ({si}): leave the unit out"
        )),
        None => Err(format!(
            "unknown unit {}: {si} would be right",
            super::rows::shown(bare(text))
        )),
    }
}

/// Returns whether two units differ in a factor of the same quantity, such as `(kN-s)` and `N s`.
pub fn differ(one: &str, other: &str) -> bool {
    factors(one).zip(factors(other)).any(|(one, other)| {
        let mut quantities = HEADER_UNITS.iter().map(|(quantity, ..)| *quantity);
        let both =
            quantities.find_map(|quantity| factor(one, quantity).ok().zip(factor(other, quantity).ok()));
        both.is_some_and(|(one, other)| one != other)
    })
}

/// Returns whether the first factor of a unit is of another quantity than that of the `expected` unit, or unknown, such as `(lbf)` for `N`.
pub fn is_foreign(text: &str, expected: &str) -> bool {
    let Some((text, expected)) = factors(text).next().zip(factors(expected).next()) else {
        return false;
    };
    let mut quantities = HEADER_UNITS.iter().map(|(quantity, ..)| *quantity);
    let quantity = quantities.find(|quantity| factor(expected, *quantity).is_ok());
    quantity.is_some_and(|quantity| factor(text, quantity).is_err())
}

/// The units in a product, without exponents: N and m of `(N-m^2)`.
fn factors(text: &str) -> impl Iterator<Item = &str> {
    let words = text.split(|c: char| !c.is_ascii_alphabetic());
    words.filter(|word| !word.is_empty())
}

/// Returns whether a text is a unit other than an SI unit.
pub(super) fn is_converted(text: &str) -> bool {
    let mut quantities = HEADER_UNITS.iter().map(|(quantity, ..)| *quantity);
    quantities.any(|quantity| factor(text, quantity).is_ok_and(|factor| factor != 1.0))
}

/// The groups in square and round brackets of a heading, such as the units in `y [km] / x [km]`.
pub(super) fn bracketed(heading: &str) -> Vec<&str> {
    let groups = heading.split(['[', '(']).skip(1);
    groups
        .filter_map(|group| group.split([']', ')']).next())
        .collect()
}

/// A unit without brackets.
pub(super) fn bare(text: &str) -> &str {
    text.trim().trim_matches(['[', ']', '(', ')', '{', '}']).trim()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_of_a_heading_is_converted_to_that_of_a_key() {
        assert_eq!(factor_to("N", "kN"), Ok(1e3));
        assert_eq!(factor_to("s", "[min]"), Ok(60.0));
        assert_eq!(factor_to("kg/m", "kg/m"), Ok(1.0));
        assert!(
            factor_to("kg/m", "g/m")
                .unwrap_err()
                .ends_with("kg/m would be right")
        );
        assert!(factor_to("m", "s").unwrap_err().contains("one of m, mm"));
        assert!(
            factor_to("m, rad", "m")
                .unwrap_err()
                .ends_with("leave the unit out")
        );
    }

    #[test]
    fn units_of_headers_are_read_in_brackets_and_without_and_others_are_refused() {
        for (text, quantity, value) in [
            ("[deg]", Quantity::Angle, PI / 180.0),
            ("(DEG)", Quantity::Angle, PI / 180.0),
            ("°", Quantity::Angle, PI / 180.0),
            ("rad", Quantity::Angle, 1.0),
            ("mm", Quantity::Length, 1e-3),
            ("Km", Quantity::Length, 1e3),
            ("ms", Quantity::Time, 1e-3),
            ("kN", Quantity::Force, 1e3),
            ("KN", Quantity::Force, 1e3),
            ("MN", Quantity::Force, 1e6),
            ("(-)", Quantity::Number, 1.0),
        ] {
            assert_eq!(factor(text, quantity), Ok(value), "{text}");
        }
        for (one, other, apart) in [
            ("(kN-s)", "N s, or a ratio", true),
            ("(mm)", "m", true),
            ("[t/m]", "kg/m", true),
            ("(rad)", "deg", true),
            ("(N-m^2)", "N m²", false),
            ("(kg)", "m³", false),
            ("(Pa-s/-)", "N s", false),
            ("(-)", "N", false),
            ("(m)", "-", false),
            ("(kg/km)", "kg/m", true),
            ("(N-mm^2)", "N m²", true),
        ] {
            assert_eq!(differ(one, other), apart, "{one} {other}");
        }
        for (text, expected, foreign) in [
            ("(lbf)", "N", true),
            ("(N/m)", "kg/m", true),
            ("(mˆ3)", "m³", false),
            ("(Kg)", "kg", false),
            ("(-)", "N", false),
            ("(name)", "-", false),
        ] {
            assert_eq!(is_foreign(text, expected), foreign, "{text} {expected}");
        }
        for (text, quantity) in [
            ("mN", Quantity::Force),
            ("Ms", Quantity::Time),
            ("furlong", Quantity::Length),
            ("deg", Quantity::Length),
            ("", Quantity::Angle),
        ] {
            let problem = factor(text, quantity).unwrap_err();
            assert!(problem.contains("would be right"), "{text}: {problem}");
        }
    }
}
