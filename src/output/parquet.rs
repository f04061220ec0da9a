//! Tables in Apache Parquet: plain columns without compression, in groups of rows of a bounded size.
//!
//! The footer is written after every group and replaced by the next one, so that the file can be read at any time. Units and descriptions are
//! metadata of the fields, in the Apache Arrow schema in the file. With 6 digits or fewer, numbers have 32 bits.
//! Sources: Apache Parquet format 2.11; Apache Arrow format 1.5, `Schema.fbs` and `Message.fbs`.

use std::io;
use std::sync::Arc;

use parquet::basic::{ConvertedType, LogicalType, Repetition, Type as PhysicalType};
use parquet::column::writer::ColumnWriter;
use parquet::data_type::ByteArray;
use parquet::errors::ParquetError;
use parquet::file::metadata::{
    ColumnChunkMetaData, FileMetaData, KeyValue, ParquetMetaData, ParquetMetaDataReader,
    ParquetMetaDataWriter, RowGroupMetaData,
};
use parquet::file::properties::{EnabledStatistics, WriterProperties, WriterPropertiesPtr};
use parquet::file::writer::{SerializedRowGroupWriter, TrackedWrite};
use parquet::schema::types::{SchemaDescPtr, SchemaDescriptor, Type};

use super::OutputError;
use super::arrow_schema;
use super::csv::rounded;
use super::growing::Growing;
use super::record::{Column, Form};

/// Bytes at the beginning and the end of a file.
const MAGIC: &[u8; 4] = b"PAR1";
/// Number of bytes after the metadata: their length and the end bytes.
const FOOTER_END: usize = 8;
/// Values of a group of rows [-]: 2 MiB.
const GROUP_VALUES: usize = 1 << 18;
/// Least number of rows of a full group [-].
const GROUP_ROWS_MIN: usize = 512;
/// Greatest number of digits that 32-bit numbers keep [-].
pub(super) const SINGLE_DIGITS: usize = 6;

/// A table that is written in groups of rows.
#[derive(Debug)]
pub(super) struct ParquetTable {
    file: Growing,
    schema: SchemaDescPtr,
    properties: WriterPropertiesPtr,
    metadata: Vec<KeyValue>,
    digits: Option<usize>,
    columns: Vec<Buffer>,
    group_rows: usize,
    groups: Vec<RowGroupMetaData>,
}

/// Values of a column that are not yet written.
#[derive(Debug)]
struct Buffer {
    form: Form,
    values: Vec<f64>,
}

impl ParquetTable {
    /// Opens a table in a new file, without rows, or in a file that continues after its last group.
    pub(super) fn open(
        file: Growing,
        columns: &[Column],
        digits: Option<usize>,
    ) -> Result<ParquetTable, OutputError> {
        let mut table = ParquetTable::new(file, columns, digits)?;
        if table.file.end() == 0 {
            let footer = table.footer().map_err(|error| table.failure(error))?;
            table.file.append(MAGIC, footer)?;
            return Ok(table);
        }
        let ending = table.file.ending();
        let metadata = &ending[..ending.len().saturating_sub(FOOTER_END)];
        let metadata = ParquetMetaDataReader::decode_metadata(metadata);
        let metadata = metadata.map_err(|error| table.failure(error))?;
        table.groups = metadata.row_groups().to_vec();
        Ok(table)
    }

    fn new(file: Growing, columns: &[Column], digits: Option<usize>) -> Result<ParquetTable, OutputError> {
        let is_single = digits.is_some_and(|digits| digits <= SINGLE_DIGITS);
        let fields: Result<Vec<_>, _> = columns.iter().map(|column| field(column, is_single)).collect();
        let schema = fields.and_then(|fields| {
            let fields = fields.into_iter().map(Arc::new).collect();
            Type::group_type_builder("schema").with_fields(fields).build()
        });
        let schema = schema.map_err(|error| file.failure(io::Error::other(error)))?;
        let properties = WriterProperties::builder()
            .set_dictionary_enabled(false)
            .set_statistics_enabled(EnabledStatistics::Chunk)
            .set_offset_index_disabled(true);
        let arrow = arrow_schema::encoded(columns, is_single);
        let group_rows = (GROUP_VALUES / columns.len().max(1)).max(GROUP_ROWS_MIN);
        let buffer = |column: &Column| Buffer {
            form: column.form.clone(),
            values: Vec::with_capacity(group_rows),
        };
        Ok(ParquetTable {
            file,
            schema: Arc::new(SchemaDescriptor::new(Arc::new(schema))),
            properties: Arc::new(properties.build()),
            metadata: vec![KeyValue::new(arrow_schema::KEY.to_string(), arrow)],
            digits,
            columns: columns.iter().map(buffer).collect(),
            group_rows,
            groups: Vec::new(),
        })
    }

    /// Adds a row with a value for every column.
    pub(super) fn row(&mut self, values: &[f64]) -> Result<(), OutputError> {
        for (column, value) in self.columns.iter_mut().zip(values) {
            column.values.push(*value);
        }
        match self.columns[0].values.len() >= self.group_rows {
            true => self.flush(),
            false => Ok(()),
        }
    }

    /// Writes the pending rows as a group.
    pub(super) fn flush(&mut self) -> Result<(), OutputError> {
        if self.columns[0].values.is_empty() {
            return Ok(());
        }
        let written = self.encode_group().and_then(|(bytes, group)| {
            self.groups.push(group);
            Ok((bytes, self.footer()?))
        });
        let (bytes, footer) = written.map_err(|error| self.failure(error))?;
        self.columns.iter_mut().for_each(|column| column.values.clear());
        self.file.append(&bytes, footer)
    }

    /// File with the groups written so far.
    pub(super) fn file(&mut self) -> &mut Growing {
        &mut self.file
    }

    fn failure(&self, error: ParquetError) -> OutputError {
        self.file.failure(io::Error::other(error))
    }

    /// Encodes the pending rows as a group; returns the bytes and the group's metadata for the end of the file.
    fn encode_group(&mut self) -> Result<(Vec<u8>, RowGroupMetaData), ParquetError> {
        let mut bytes = TrackedWrite::new(Vec::new());
        let mut group = SerializedRowGroupWriter::new(
            self.schema.clone(),
            self.properties.clone(),
            &mut bytes,
            self.groups.len() as i32,
            None,
        );
        let mut scratch = String::new();
        for column in &mut self.columns {
            if let (Form::Real | Form::Sparse, Some(digits)) = (&column.form, self.digits) {
                let values = column.values.iter_mut();
                values.for_each(|value| *value = rounded(*value, digits, &mut scratch));
            }
            let mut writer = group
                .next_column()?
                .expect("a writer for every column of the schema");
            write_column(column, writer.untyped())?;
            writer.close()?;
        }
        let metadata = group.close()?;
        let shift = self.file.end() as i64;
        let metadata = shifted(&metadata, shift)?;
        Ok((bytes.into_inner()?, metadata))
    }

    /// End of the file, with the metadata of all groups.
    fn footer(&self) -> Result<Vec<u8>, ParquetError> {
        let rows = self.groups.iter().map(RowGroupMetaData::num_rows).sum();
        let by = format!("moorline {}", env!("CARGO_PKG_VERSION"));
        let file = FileMetaData::new(
            1,
            rows,
            Some(by),
            Some(self.metadata.clone()),
            self.schema.clone(),
            None,
        );
        let metadata = ParquetMetaData::new(file, self.groups.clone());
        let mut footer = Vec::new();
        ParquetMetaDataWriter::new(&mut footer, &metadata).finish()?;
        Ok(footer)
    }
}

/// Field of a column.
fn field(column: &Column, is_single: bool) -> Result<Type, ParquetError> {
    let physical = match column.form {
        Form::Exact => PhysicalType::DOUBLE,
        Form::Real | Form::Sparse if is_single => PhysicalType::FLOAT,
        Form::Real | Form::Sparse => PhysicalType::DOUBLE,
        Form::Whole => PhysicalType::INT64,
        Form::Name(_) => PhysicalType::BYTE_ARRAY,
    };
    let repetition = match column.form {
        Form::Sparse => Repetition::OPTIONAL,
        _ => Repetition::REQUIRED,
    };
    let field = Type::primitive_type_builder(&column.name, physical).with_repetition(repetition);
    match column.form {
        Form::Name(_) => field
            .with_converted_type(ConvertedType::UTF8)
            .with_logical_type(Some(LogicalType::String))
            .build(),
        _ => field.build(),
    }
}

fn write_column(column: &Buffer, writer: &mut ColumnWriter<'_>) -> Result<(), ParquetError> {
    let is_sparse = column.form == Form::Sparse;
    let levels = column.values.iter().map(|value| i16::from(!value.is_nan()));
    let levels: Option<Vec<i16>> = is_sparse.then(|| levels.collect());
    let levels = levels.as_deref();
    let values = column.values.iter().copied();
    let values = values.filter(|value| !(is_sparse && value.is_nan()));
    match (writer, &column.form) {
        (ColumnWriter::DoubleColumnWriter(writer), _) => {
            writer.write_batch(&values.collect::<Vec<f64>>(), levels, None)
        }
        (ColumnWriter::FloatColumnWriter(writer), _) => {
            let singles: Vec<f32> = values.map(|value| value as f32).collect();
            writer.write_batch(&singles, levels, None)
        }
        (ColumnWriter::Int64ColumnWriter(writer), _) => {
            let whole: Vec<i64> = values.map(|value| value as i64).collect();
            writer.write_batch(&whole, None, None)
        }
        (ColumnWriter::ByteArrayColumnWriter(writer), Form::Name(names)) => {
            let names: Vec<ByteArray> = names.iter().map(|name| name.as_str().into()).collect();
            let texts: Vec<ByteArray> = values.map(|value| names[value as usize].clone()).collect();
            writer.write_batch(&texts, None, None)
        }
        _ => unreachable!("the schema has no other types"),
    }
    .map(|_| ())
}

/// Metadata of a group shifted by a number of bytes.
fn shifted(group: &RowGroupMetaData, by: i64) -> Result<RowGroupMetaData, ParquetError> {
    let chunk = |chunk: &ColumnChunkMetaData| {
        let (data, dictionary) = (chunk.data_page_offset(), chunk.dictionary_page_offset());
        let builder = chunk.clone().into_builder().set_data_page_offset(data + by);
        builder
            .set_dictionary_page_offset(dictionary.map(|offset| offset + by))
            .build()
    };
    let chunks: Result<Vec<_>, _> = group.columns().iter().map(chunk).collect();
    let offset = group.file_offset().unwrap_or(0) + by;
    let builder = group.clone().into_builder();
    builder
        .set_column_metadata(chunks?)
        .set_file_offset(offset)
        .build()
}

#[cfg(test)]
mod tests {
    use super::*;
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::Field;
    use std::fs::File;
    use std::path::Path;

    fn columns() -> Vec<Column> {
        let names = vec!["line1".to_string(), "line ü".to_string()];
        vec![
            Column::time(),
            Column::new("line", "1", "its name", Form::Name(names)),
            Column::new("solver.substeps", "1", "steps", Form::Whole),
            Column::new("line1.tension_b", "N", "tension at end B", Form::Real),
            Column::new("moment", "N.m", "bending moment", Form::Sparse),
        ]
    }

    fn row(i: usize) -> [f64; 5] {
        let value = i as f64;
        let moment = if i.is_multiple_of(3) {
            f64::NAN
        } else {
            0.1 * value
        };
        [0.1 * value, (i % 2) as f64, value, (0.3 * value).sin(), moment]
    }

    /// Rows of a file: the line, and the other values.
    fn rows(path: &Path) -> Vec<(String, [Option<f64>; 4])> {
        let number = |field: &Field| match field {
            Field::Double(value) => Some(*value),
            Field::Long(value) => Some(*value as f64),
            Field::Null => None,
            other => panic!("{other}"),
        };
        let file = SerializedFileReader::new(File::open(path).unwrap()).unwrap();
        let rows = file.get_row_iter(None).unwrap().map(|row| {
            let row = row.unwrap();
            let fields: Vec<&Field> = row.get_column_iter().map(|(_, field)| field).collect();
            let Field::Str(line) = fields[1] else {
                panic!("{row}")
            };
            (line.clone(), [0, 2, 3, 4].map(|column| number(fields[column])))
        });
        rows.collect()
    }

    fn expected(i: usize) -> (String, [Option<f64>; 4]) {
        let [time, line, steps, tension, moment] = row(i);
        let line = ["line1", "line ü"][line as usize].to_string();
        let moment = Some(moment).filter(|moment| !moment.is_nan());
        (line, [Some(time), Some(steps), Some(tension), moment])
    }

    #[test]
    fn a_table_can_be_read_after_every_group_and_continues_behind_a_mark() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("results.parquet");
        let file = Growing::create(&path).unwrap();
        let mut table = ParquetTable::open(file, &columns(), None).unwrap();
        assert!(rows(&path).is_empty());
        let whole = table.group_rows;
        (0..whole + 10).for_each(|i| table.row(&row(i)).unwrap());
        assert_eq!(rows(&path).len(), whole);
        table.flush().unwrap();
        let mark = table.file().mark().unwrap();
        (0..100).for_each(|i| table.row(&row(i)).unwrap());
        table.flush().unwrap();
        assert_eq!(rows(&path).len(), whole + 110);
        let file = Growing::reopen(&path, mark).unwrap();
        let mut table = ParquetTable::open(file, &columns(), None).unwrap();
        assert_eq!(rows(&path).len(), whole + 10);
        (whole + 10..whole + 20).for_each(|i| table.row(&row(i)).unwrap());
        table.flush().unwrap();
        let found = rows(&path);
        assert_eq!(found.len(), whole + 20);
        assert!(found.iter().enumerate().all(|(i, row)| *row == expected(i)));
    }

    /// The number of values held until they are written is bounded for any number of rows.
    #[test]
    fn a_table_keeps_a_bounded_number_of_values() {
        let folder = tempfile::tempdir().unwrap();
        let file = Growing::create(&folder.path().join("a.parquet")).unwrap();
        let mut table = ParquetTable::open(file, &columns(), None).unwrap();
        for i in 0..300_000 {
            table.row(&row(i)).unwrap();
            let kept: usize = table.columns.iter().map(|column| column.values.len()).sum();
            assert!(kept <= GROUP_VALUES);
        }
        assert!(
            table
                .columns
                .iter()
                .all(|column| column.values.capacity() == table.group_rows)
        );
        assert_eq!(table.groups.len(), 300_000 / table.group_rows);
    }
}
