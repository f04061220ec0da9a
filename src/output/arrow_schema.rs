//! Schema of Apache Arrow for the metadata of a Parquet file, with unit and description of every field.
//!
//! Source: Apache Arrow format 1.5, `Schema.fbs`, `Message.fbs` (numbers of fields by their order there) and *Encapsulated message format*.

use flatbuffers::{FlatBufferBuilder, TableFinishedWIPOffset, VOffsetT, WIPOffset};

use super::record::{Column, Form};

/// Key of the schema in the metadata of a file.
pub(super) const KEY: &str = "ARROW:schema";
/// `MetadataVersion::V5`.
const VERSION: i16 = 4;
/// `MessageHeader::Schema`.
const SCHEMA: u8 = 1;
/// `Type::Int`.
const INT: u8 = 2;
/// `Type::FloatingPoint`.
const FLOATING_POINT: u8 = 3;
/// `Type::Utf8`.
const UTF8: u8 = 5;
/// `Precision::SINGLE`.
const SINGLE: i16 = 1;
/// `Precision::DOUBLE`.
const DOUBLE: i16 = 2;

type Table = WIPOffset<TableFinishedWIPOffset>;

/// Offset in a table of the field with this number.
const fn slot(number: VOffsetT) -> VOffsetT {
    4 + 2 * number
}

/// Returns the schema of columns as an encapsulated message in base64.
pub(super) fn encoded(columns: &[Column], is_single: bool) -> String {
    let mut builder = FlatBufferBuilder::new();
    let fields: Vec<Table> = columns
        .iter()
        .map(|column| field(&mut builder, column, is_single))
        .collect();
    let fields = builder.create_vector(&fields);
    let start = builder.start_table();
    builder.push_slot_always(slot(1), fields);
    let schema = builder.end_table(start);
    let start = builder.start_table();
    builder.push_slot_always(slot(0), VERSION);
    builder.push_slot_always(slot(1), SCHEMA);
    builder.push_slot_always(slot(2), schema);
    let message = builder.end_table(start);
    builder.finish(message, None);
    let body = builder.finished_data();
    let padded = body.len().next_multiple_of(8);
    let mut bytes = vec![0xff; 4];
    bytes.extend((padded as u32).to_le_bytes());
    bytes.extend(body);
    bytes.resize(8 + padded, 0);
    base64(&bytes)
}

fn field(builder: &mut FlatBufferBuilder<'_>, column: &Column, is_single: bool) -> Table {
    let name = builder.create_string(&column.name);
    let entries = [("unit", &column.unit), ("description", &column.description)];
    let entries = entries.map(|(key, value)| {
        let (key, value) = (builder.create_string(key), builder.create_string(value));
        let start = builder.start_table();
        builder.push_slot_always(slot(0), key);
        builder.push_slot_always(slot(1), value);
        builder.end_table(start)
    });
    let entries = builder.create_vector(&entries);
    let children = builder.create_vector::<Table>(&[]);
    let (member, kind) = kind(builder, &column.form, is_single);
    let start = builder.start_table();
    builder.push_slot_always(slot(0), name);
    builder.push_slot_always(slot(1), column.form == Form::Sparse);
    builder.push_slot_always(slot(2), member);
    builder.push_slot_always(slot(3), kind);
    builder.push_slot_always(slot(5), children);
    builder.push_slot_always(slot(6), entries);
    builder.end_table(start)
}

/// Type of a column: the union member and its table.
fn kind(builder: &mut FlatBufferBuilder<'_>, form: &Form, is_single: bool) -> (u8, Table) {
    let start = builder.start_table();
    let member = match form {
        Form::Whole => {
            builder.push_slot_always(slot(0), 64_i32);
            builder.push_slot_always(slot(1), true);
            INT
        }
        Form::Name(_) => UTF8,
        Form::Exact | Form::Real | Form::Sparse => {
            let is_single = is_single && *form != Form::Exact;
            builder.push_slot_always(slot(0), if is_single { SINGLE } else { DOUBLE });
            FLOATING_POINT
        }
    };
    (member, builder.end_table(start))
}

/// Encodes bytes in base64. Source: RFC 4648, section 4.
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let byte = |i: usize| u32::from(*chunk.get(i).unwrap_or(&0));
        let word = byte(0) << 16 | byte(1) << 8 | byte(2);
        for place in 0..4 {
            let digit = DIGITS[(word >> (18 - 6 * place)) as usize & 63];
            text.push(if place <= chunk.len() {
                char::from(digit)
            } else {
                '='
            });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Source: RFC 4648, section 10.
    #[test]
    fn base64_gives_the_vectors_of_its_standard() {
        let vectors = [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foobar", "Zm9vYmFy"),
        ];
        for (plain, coded) in vectors {
            assert_eq!(base64(plain.as_bytes()), coded);
        }
    }
}
