//! ParaView files: one `.vtp` (VTK poly data) for every frame and one `.pvd` that places them in time.
//!
//! Every line is a poly-line. Point data: `tension` [N] and `s`, the unstretched arc length [m]. Cell data: `line`, the
//! line's number in the order of the scene. Numbers are inline text, so that the files can be read without ParaView.
//! Source: VTK file formats, chapters "XML File Formats" (PolyData) and the ParaView guide (PVD collections).

use std::io::{self, Write};

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesText, Event};

use super::csv::shortest;
use super::record::{Frame, Node};

/// Folder of the frames, next to the collection.
pub const FRAME_FOLDER: &str = "vtk";

/// Name of a frame's file, relative to the collection, with a forward slash on every system.
pub fn frame_name(index: usize) -> String {
    format!("{FRAME_FOLDER}/lines_{index:05}.vtp")
}

/// Writes the shape of all lines at one instant as `.vtp`.
///
/// # Errors
/// Writing to `out` fails.
pub fn write_frame(frame: &Frame, out: impl Write) -> io::Result<()> {
    let nodes: Vec<Node> = frame.lines.iter().flatten().copied().collect();
    let mut xml = document(out)?;
    xml.create_element("VTKFile")
        .with_attributes([
            ("type", "PolyData"),
            ("version", "1.0"),
            ("byte_order", "LittleEndian"),
        ])
        .write_inner_content(|xml| {
            xml.create_element("PolyData").write_inner_content(|xml| {
                let counts = [
                    ("NumberOfPoints", nodes.len().to_string()),
                    ("NumberOfLines", frame.lines.len().to_string()),
                ];
                xml.create_element("Piece")
                    .with_attributes(counts.iter().map(|(key, n)| (*key, n.as_str())))
                    .write_inner_content(|xml| write_piece(xml, frame, &nodes))?;
                Ok(())
            })?;
            Ok(())
        })?;
    xml.into_inner().flush()
}

fn write_piece<W: Write>(xml: &mut Writer<W>, frame: &Frame, nodes: &[Node]) -> io::Result<()> {
    xml.create_element("PointData")
        .with_attribute(("Scalars", "tension"))
        .write_inner_content(|xml| {
            write_array(
                xml,
                "Float64",
                "tension",
                1,
                nodes.iter().map(|n| shortest(n.tension)),
            )?;
            write_array(xml, "Float64", "s", 1, nodes.iter().map(|n| shortest(n.s)))
        })?;
    xml.create_element("CellData").write_inner_content(|xml| {
        write_array(
            xml,
            "Int32",
            "line",
            1,
            (0..frame.lines.len()).map(|i| i.to_string()),
        )
    })?;
    xml.create_element("Points").write_inner_content(|xml| {
        let coordinates = nodes.iter().flat_map(|n| n.position).map(shortest);
        write_array(xml, "Float64", "position", 3, coordinates)
    })?;
    xml.create_element("Lines").write_inner_content(|xml| {
        // Every line owns a run of the points; `offsets` holds where each run ends.
        let ends = frame.lines.iter().scan(0, |end, line| {
            *end += line.len();
            Some(end.to_string())
        });
        let connectivity = (0..nodes.len()).map(|i| i.to_string());
        write_array(xml, "Int64", "connectivity", 1, connectivity)?;
        write_array(xml, "Int64", "offsets", 1, ends)
    })?;
    Ok(())
}

/// Writes one array as text, a tuple of `components` numbers a line.
fn write_array<W: Write>(
    xml: &mut Writer<W>,
    kind: &str,
    name: &str,
    components: usize,
    values: impl Iterator<Item = String>,
) -> io::Result<()> {
    let mut text = String::from("\n");
    for (index, value) in values.enumerate() {
        text.push_str(&value);
        text.push(if (index + 1) % components == 0 { '\n' } else { ' ' });
    }
    let components = components.to_string();
    xml.create_element("DataArray")
        .with_attributes([
            ("type", kind),
            ("Name", name),
            ("NumberOfComponents", components.as_str()),
            ("format", "ascii"),
        ])
        .write_text_content(BytesText::new(&text))?;
    Ok(())
}

/// Writes the collection `.pvd` of frames at these times [s], named by [`frame_name`].
///
/// # Errors
/// Writing to `out` fails.
pub fn write_collection(times: impl Iterator<Item = f64>, out: impl Write) -> io::Result<()> {
    let mut xml = document(out)?;
    xml.create_element("VTKFile")
        .with_attributes([
            ("type", "Collection"),
            ("version", "1.0"),
            ("byte_order", "LittleEndian"),
        ])
        .write_inner_content(|xml| {
            xml.create_element("Collection").write_inner_content(|xml| {
                for (index, time) in times.enumerate() {
                    let (time, file) = (shortest(time), frame_name(index));
                    xml.create_element("DataSet")
                        .with_attributes([
                            ("timestep", time.as_str()),
                            ("part", "0"),
                            ("file", file.as_str()),
                        ])
                        .write_empty()?;
                }
                Ok(())
            })?;
            Ok(())
        })?;
    xml.into_inner().flush()
}

fn document<W: Write>(out: W) -> io::Result<Writer<W>> {
    let mut xml = Writer::new_with_indent(out, b' ', 1);
    xml.write_event(Event::Decl(BytesDecl::new("1.0", None, None)))?;
    Ok(xml)
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
        let frame = &sample::record().frames[1];
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

    #[test]
    fn the_collection_names_every_frame_at_its_time() {
        let mut bytes = Vec::new();
        write_collection([0.0, 0.25].into_iter(), &mut bytes).unwrap();
        let xml = String::from_utf8(bytes).unwrap();
        assert!(xml.contains(r#"<DataSet timestep="0.25" part="0" file="vtk/lines_00001.vtp"/>"#));
        assert_eq!(xml.matches("<DataSet ").count(), 2);
    }
}
