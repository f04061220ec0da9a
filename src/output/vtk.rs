//! ParaView files: one `.vtp` (VTK poly data) for every frame and one `.pvd` that assigns times to them.
//!
//! Every line is a poly-line. Point data: `tension` [N] and `s`, the unstretched arc length [m]. Cell data: `line`, the
//! line's number in the order of the scene. Numbers are inline text, so that the files can be read without ParaView.
//! Source: VTK file formats, chapters "XML File Formats" (PolyData) and the ParaView guide (PVD collections).

use std::io::{self, Write};

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesText, Event};

use super::csv::{push_shortest, push_whole, shortest};
use super::record::{Frame, Node};
use super::xml::{texts, within};

/// Folder of the frames, next to the collection.
pub const FRAME_FOLDER: &str = "vtk";

/// Name of a frame's file, relative to the collection, with a forward slash on every system.
pub fn frame_name(index: usize) -> String {
    format!("{FRAME_FOLDER}/lines_{index:05}.vtp")
}

/// Returns whether a name is that of a frame's file in its folder.
pub(super) fn is_frame(name: &str) -> bool {
    let number = name
        .strip_prefix("lines_")
        .and_then(|rest| rest.strip_suffix(".vtp"));
    number.is_some_and(|number| number.len() >= 5 && number.bytes().all(|byte| byte.is_ascii_digit()))
}

/// Writes the shape of all lines at one instant as `.vtp`.
///
/// # Errors
/// Writing to `out` fails.
pub fn write_frame(frame: &Frame, out: impl Write) -> io::Result<()> {
    let nodes: Vec<Node> = frame.lines.iter().flatten().copied().collect();
    let root = [
        ("type", "PolyData"),
        ("version", "1.0"),
        ("byte_order", "LittleEndian"),
    ];
    let counts = [
        ("NumberOfPoints", nodes.len().to_string()),
        ("NumberOfLines", frame.lines.len().to_string()),
    ];
    let mut xml = Writer::new_with_indent(out, b' ', 1);
    xml.write_event(Event::Decl(BytesDecl::new("1.0", None, None)))?;
    within(&mut xml, "VTKFile", &root, |xml| {
        within(xml, "PolyData", &[], |xml| {
            within(xml, "Piece", &texts(&counts), |xml| {
                write_piece(xml, frame, &nodes)
            })
        })
    })?;
    xml.into_inner().flush()
}

fn write_piece<W: Write>(xml: &mut Writer<W>, frame: &Frame, nodes: &[Node]) -> io::Result<()> {
    let reals = |values: &mut dyn Iterator<Item = f64>, components| tuples(values, components, push_shortest);
    let wholes = |values: &mut dyn Iterator<Item = usize>| {
        tuples(values, 1, |text, value| push_whole(text, value as f64))
    };
    within(xml, "PointData", &[("Scalars", "tension")], |xml| {
        let tensions = reals(&mut nodes.iter().map(|node| node.tension), 1);
        write_array(xml, ["Float64", "tension", "1"], &tensions)?;
        let arcs = reals(&mut nodes.iter().map(|node| node.s), 1);
        write_array(xml, ["Float64", "s", "1"], &arcs)
    })?;
    within(xml, "CellData", &[], |xml| {
        let lines = wholes(&mut (0..frame.lines.len()));
        write_array(xml, ["Int32", "line", "1"], &lines)
    })?;
    within(xml, "Points", &[], |xml| {
        let positions = reals(&mut nodes.iter().flat_map(|node| node.position), 3);
        write_array(xml, ["Float64", "position", "3"], &positions)
    })?;
    within(xml, "Lines", &[], |xml| {
        // The points of every line are contiguous; `offsets` holds the end of each line.
        let mut ends = frame.lines.iter().scan(0, |end, line| {
            *end += line.len();
            Some(*end)
        });
        let connectivity = wholes(&mut (0..nodes.len()));
        write_array(xml, ["Int64", "connectivity", "1"], &connectivity)?;
        write_array(xml, ["Int64", "offsets", "1"], &wholes(&mut ends))
    })
}

/// Text of values with `components` numbers in a row.
fn tuples<T>(
    values: &mut dyn Iterator<Item = T>,
    components: usize,
    push: impl Fn(&mut Vec<u8>, T),
) -> String {
    let mut text = b"\n".to_vec();
    for (index, value) in values.enumerate() {
        push(&mut text, value);
        text.push(if (index + 1) % components == 0 {
            b'\n'
        } else {
            b' '
        });
    }
    String::from_utf8(text).expect("numbers are ASCII")
}

/// Writes one array as text, with its type, name and number of components.
fn write_array<W: Write>(
    xml: &mut Writer<W>,
    [kind, name, components]: [&str; 3],
    text: &str,
) -> io::Result<()> {
    xml.create_element("DataArray")
        .with_attributes([
            ("type", kind),
            ("Name", name),
            ("NumberOfComponents", components),
            ("format", "ascii"),
        ])
        .write_text_content(BytesText::from_escaped(text))?;
    Ok(())
}

/// Beginning of the collection `.pvd` of frames.
pub(super) const COLLECTION: &str = "<?xml version=\"1.0\"?>
<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">
 <Collection>
";
/// End of the collection.
pub(super) const COLLECTION_END: &str = " </Collection>\n</VTKFile>";

/// Entry of a frame at a time [s] in the collection, named by [`frame_name`].
pub(super) fn collected(index: usize, time: f64) -> String {
    let (time, file) = (shortest(time), frame_name(index));
    format!("  <DataSet timestep=\"{time}\" part=\"0\" file=\"{file}\"/>\n")
}

#[cfg(test)]
mod tests {
    use super::super::sample;
    use super::*;
    use quick_xml::Reader;

    /// Numbers of every array by name.
    fn arrays(xml: &str) -> Vec<(String, Vec<f64>)> {
        let mut reader = Reader::from_str(xml);
        let mut arrays: Vec<(String, Vec<f64>)> = Vec::new();
        let mut inside = false;
        loop {
            match reader.read_event().unwrap() {
                Event::Start(tag) if tag.name().as_ref() == "DataArray" => {
                    let name = tag.try_get_attribute("Name").unwrap().unwrap().value;
                    arrays.push((name.into_owned(), Vec::new()));
                    inside = true;
                }
                Event::Text(text) if inside => {
                    let numbers = text.split_whitespace().map(|n| n.parse::<f64>().unwrap());
                    arrays.last_mut().unwrap().1.extend(numbers);
                }
                Event::End(_) => inside = false,
                Event::Eof => return arrays,
                _ => {}
            }
        }
    }

    #[test]
    fn a_frame_reads_back_to_the_same_numbers() {
        let frame = &sample::record().course.frames[1];
        let mut bytes = Vec::new();
        write_frame(frame, &mut bytes).unwrap();
        let arrays = arrays(std::str::from_utf8(&bytes).unwrap());
        let get = |name: &str| &arrays.iter().find(|(n, _)| n == name).unwrap().1;
        let nodes: Vec<Node> = frame.lines.iter().flatten().copied().collect();
        assert_eq!(
            *get("tension"),
            nodes.iter().map(|n| n.tension).collect::<Vec<_>>()
        );
        assert_eq!(*get("s"), nodes.iter().map(|n| n.s).collect::<Vec<_>>());
        assert_eq!(
            *get("position"),
            nodes.iter().flat_map(|n| n.position).collect::<Vec<_>>()
        );
        assert_eq!(get("connectivity").len(), nodes.len());
        let first = frame.lines[0].len() as f64;
        assert_eq!(*get("offsets"), [first, nodes.len() as f64]);
        assert_eq!(*get("line"), [0.0, 1.0]);
    }
}
