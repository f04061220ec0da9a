//! Names of output channels in MoorDyn's notation: `FairTen1`, `AnchTen1`, `Con4Fx`, `L1N10T`, `Line3NAPz`.
//!
//! Numbers are those of a deck: line `1` is the scene's `line1`, point `1` is `point1`. Case is ignored.

pub use super::LineEnd;
use super::Scene;

/// Output channel: a quantity of a node or point.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Channel {
    /// `L1N10Px`: quantity of a node of a line. `FairTen1` and `AnchTen1` are the tension of the segment at end B and A.
    Node {
        /// Name of the line.
        line: String,
        /// Node of the line.
        node: NodePlace,
        /// Quantity.
        quantity: Quantity,
    },
    /// `Con4Fx`, `Point4Fx`: quantity of a point.
    Point {
        /// Name of the point.
        point: String,
        /// Quantity.
        quantity: Quantity,
    },
}

/// A node of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NodePlace {
    /// Counted from end A, which is 0.
    Number(usize),
    /// First or last node.
    End(LineEnd),
}

/// Quantity of a node or a point; axes 0, 1, 2 are x, y, z.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// `Px`: position [m], global axes.
    Position(usize),
    /// `Vx`: velocity [m/s].
    Velocity(usize),
    /// `Fx`: force of the lines on a point [N].
    Force(usize),
    /// `T`, `Ten`: tension of the segments next to a node, or size of the force on a point [N].
    Tension,
}

/// Accepted names, for messages.
const ACCEPTED: &str =
    "FairTen1, AnchTen1, L1N10T, L1N10Px, L1N10Vx, Point1Px, Point1Vx, Point1Fx and Point1T, with x, y or z";

impl Channel {
    /// Reads the name of a channel.
    ///
    /// # Errors
    /// The mistake in the name, and the accepted names.
    pub fn parse(name: &str) -> Result<Channel, String> {
        let upper = name.to_uppercase();
        let (what, rest) = split_letters(&upper);
        let (number, rest) = split_digits(rest);
        let unknown = || format!("unknown output channel `{name}`; known are {ACCEPTED}");
        let number: usize = number.parse().map_err(|_| unknown())?;
        let line = format!("line{number}");
        match (what, rest) {
            ("FAIRTEN", "") => Ok(Channel::end_tension(line, LineEnd::B)),
            ("ANCHTEN", "") => Ok(Channel::end_tension(line, LineEnd::A)),
            ("L" | "LINE", rest) => {
                let (node, rest) = node(rest).ok_or_else(unknown)?;
                let quantity = quantity(rest).ok_or_else(unknown)?;
                if let Quantity::Force(_) = quantity {
                    return Err(unknown());
                }
                Ok(Channel::Node { line, node, quantity })
            }
            ("C" | "CON" | "P" | "POINT" | "N" | "NODE", rest) => Ok(Channel::Point {
                point: format!("point{number}"),
                quantity: quantity(rest).ok_or_else(unknown)?,
            }),
            ("B" | "BODY" | "R" | "ROD", _) => Err(format!(
                "the channel `{name}` of a body or rod is not written: forces and motions of a vessel are columns by its \
                 name, such as vessel.fx; known are {ACCEPTED}"
            )),
            _ => Err(unknown()),
        }
    }

    fn end_tension(line: String, end: LineEnd) -> Channel {
        Channel::Node {
            line,
            node: NodePlace::End(end),
            quantity: Quantity::Tension,
        }
    }

    /// Returns whether a name denotes a tension of a line.
    pub(super) fn is_tension(name: &str) -> bool {
        let quantity = match Channel::parse(name) {
            Ok(Channel::Node { quantity, .. }) => Some(quantity),
            _ => None,
        };
        quantity == Some(Quantity::Tension)
    }

    /// Checks that the scene has the line, point or node of the channel.
    ///
    /// # Errors
    /// The line, point or node that the scene lacks.
    pub fn check(&self, scene: &Scene) -> Result<(), String> {
        match self {
            Channel::Node { line, node, .. } => {
                let line = find_line(scene, line)?;
                match (node, line.element_count()) {
                    (NodePlace::Number(node), Some(elements)) => check_node(*node, elements),
                    _ => Ok(()),
                }
            }
            Channel::Point { point, .. } => match scene.point(point) {
                Some(_) => Ok(()),
                None => Err(format!("no point is called `{point}`")),
            },
        }
    }
}

fn find_line<'s>(scene: &'s Scene, name: &str) -> Result<&'s super::Line, String> {
    let mut lines = scene.lines.iter();
    lines
        .find(|line| line.name == name)
        .ok_or_else(|| format!("no line is called `{name}`"))
}

/// Checks that a line of `elements` elements has a node.
///
/// # Errors
/// The number of nodes of the line.
pub(crate) fn check_node(node: usize, elements: usize) -> Result<(), String> {
    if node > elements {
        return Err(format!(
            "node {node} of a line of {elements} elements, whose nodes are 0 at end A to {elements} at end B"
        ));
    }
    Ok(())
}

fn split_letters(text: &str) -> (&str, &str) {
    text.split_at(text.find(|c: char| c.is_ascii_digit()).unwrap_or(text.len()))
}

fn split_digits(text: &str) -> (&str, &str) {
    text.split_at(text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len()))
}

/// `N10…`, `NA…`, `NB…`.
fn node(text: &str) -> Option<(NodePlace, &str)> {
    let rest = text.strip_prefix("NODE").or_else(|| text.strip_prefix('N'))?;
    let (digits, after) = split_digits(rest);
    if !digits.is_empty() {
        return Some((NodePlace::Number(digits.parse().ok()?), after));
    }
    let a = rest.strip_prefix('A').map(|after| (LineEnd::A, after));
    let b = rest.strip_prefix('B').map(|after| (LineEnd::B, after));
    a.or(b).map(|(end, after)| (NodePlace::End(end), after))
}

fn quantity(text: &str) -> Option<Quantity> {
    if ["T", "TEN"].contains(&text) {
        return Some(Quantity::Tension);
    }
    let mut letters = text.chars();
    let (what, axis, None) = (letters.next()?, letters.next()?, letters.next()) else {
        return None;
    };
    let axis = ['X', 'Y', 'Z'].iter().position(|letter| *letter == axis)?;
    match what {
        'P' => Some(Quantity::Position(axis)),
        'V' => Some(Quantity::Velocity(axis)),
        'F' => Some(Quantity::Force(axis)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_names_that_decks_ask_for_are_understood() {
        let end = |name: &str, line: &str, end| {
            let line = line.to_string();
            assert_eq!(Channel::parse(name), Ok(Channel::end_tension(line, end)));
        };
        end("FairTen1", "line1", LineEnd::B);
        end("ANCHTEN12", "line12", LineEnd::A);
        let node = |name: &str, node, quantity| {
            let line = "line3".to_string();
            let channel = Channel::Node { line, node, quantity };
            assert_eq!(Channel::parse(name), Ok(channel));
        };
        node("L3N10T", NodePlace::Number(10), Quantity::Tension);
        node("l3n0ten", NodePlace::Number(0), Quantity::Tension);
        node("L3N19Px", NodePlace::Number(19), Quantity::Position(0));
        node("LINE3NAPZ", NodePlace::End(LineEnd::A), Quantity::Position(2));
        node("L3NBVy", NodePlace::End(LineEnd::B), Quantity::Velocity(1));
        let point = |name: &str, quantity| {
            let point = "point4".to_string();
            assert_eq!(Channel::parse(name), Ok(Channel::Point { point, quantity }));
        };
        point("Con4Fx", Quantity::Force(0));
        point("P4FZ", Quantity::Force(2));
        point("Point4Py", Quantity::Position(1));
        point("C4T", Quantity::Tension);
    }

    #[test]
    fn any_other_name_is_refused_with_what_is_known() {
        for name in [
            "",
            "fx",
            "FairTen",
            "FairTen1x",
            "L1",
            "L1T",
            "L1N",
            "L1NCPx",
            "L1N2Q",
            "L1N2Fx",
            "Con1",
            "Con1Ax",
            "ConPx",
            "Q1T",
            "T1T",
            "Body1Px",
            "R1N2Px",
            "FairTen99999999999999999999999",
            "ü1T",
            "L1N1PxPy",
        ] {
            let problem = Channel::parse(name).unwrap_err();
            assert!(problem.contains("known are FairTen1"), "{name}: {problem}");
        }
    }
}
