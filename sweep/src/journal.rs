//! Rows of a sweep, stored as cases end, so that the sweep can be killed at any moment.
//!
//! Format: a mark with the version, then records, each sealed ([`moorline::output::sealed`]) and preceded by its length. The first record identifies the
//! sweep. A record is appended in one write. When the journal is opened, a truncated or damaged record and all records after it are removed, and their
//! cases run again.

use std::collections::HashMap;
use std::fs::{File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use moorline::output::{OutputError, sealed};
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use sha2::{Digest, Sha256};

use crate::SweepError;
use crate::case::Case;
use crate::row::{Figures, Quantity, Results, Row};

/// Name of the file in the folder of the sweep.
pub const JOURNAL: &str = "sweep.journal";

const MARK: &str = concat!("moorline sweep 2 ", env!("CARGO_PKG_VERSION"), "\n");
/// Bytes of the length of a record.
const LENGTH: usize = 4;
/// Bytes of a checksum.
const SUM: usize = 32;

/// Fingerprint of the input of a sweep.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Identity {
    /// Number of cases [-].
    pub cases: usize,
    /// Hash of the scenes of all cases, in their order, as the base and CASES give them.
    pub scenes: [u8; SUM],
    /// Hash of the files that they name.
    pub files: [u8; SUM],
    /// Hash of the times from which results count, and of the choice of series.
    pub options: [u8; SUM],
}

impl Identity {
    /// Hash of the scenes, files and options together.
    pub(crate) fn fingerprint(&self) -> [u8; SUM] {
        let parts = [&self.scenes[..], &self.files, &self.options].concat();
        Sha256::digest(parts).into()
    }

    /// Difference from another sweep, in words that follow "it holds".
    fn difference(&self, other: &Identity) -> Option<String> {
        if self.scenes != other.scenes {
            return Some(match self.cases == other.cases {
                true => "a sweep of another base or other cases".to_string(),
                false => format!("a sweep of {} cases, which are {} here", self.cases, other.cases),
            });
        }
        if self.files != other.files {
            return Some("a sweep whose files (motions, tables) had other content".to_string());
        }
        (self.options != other.options).then(|| "a sweep with other options (--from, --series)".to_string())
    }
}

/// A record after the first.
#[derive(Debug, Serialize, Deserialize)]
enum Record {
    /// The next list of quantities that rows refer to.
    Quantities(Vec<Quantity>),
    /// The end of a case: its number, the figures of a list of quantities or the reason of its failure, and remarks.
    Case(usize, Result<(usize, Vec<Figures>), String>, Vec<String>),
}

/// A journal that is open.
#[derive(Debug)]
pub(crate) struct Journal {
    path: PathBuf,
    file: File,
    quantities: HashMap<Arc<Vec<Quantity>>, usize>,
}

impl Journal {
    /// Opens the journal of a folder, or creates one; returns the rows of the cases that have ended.
    ///
    /// # Errors
    /// The journal belongs to another sweep or version, or cannot be read or written.
    pub(crate) fn open(
        folder: &Path,
        identity: &Identity,
        cases: &[Case],
    ) -> Result<(Journal, Vec<Row>), SweepError> {
        let path = folder.join(JOURNAL);
        let in_file = |source| OutputError::File {
            path: path.clone(),
            source,
        };
        let opened = OpenOptions::new()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(&path);
        let mut file = opened.map_err(in_file)?;
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).map_err(in_file)?;
        let mut journal = Journal {
            path: path.clone(),
            file,
            quantities: HashMap::new(),
        };
        if MARK.as_bytes().starts_with(&bytes) || bytes.len() == MARK.len() {
            journal.begin(identity, &bytes)?;
            return Ok((journal, Vec::new()));
        }
        let Some(records) = bytes.strip_prefix(MARK.as_bytes()) else {
            return Err(SweepError::Other {
                path,
                problem: "no journal of a sweep of this version of moorline".to_string(),
            });
        };
        let Some((found, mut rest)) = first::<Identity>(records) else {
            journal.begin(identity, MARK.as_bytes())?;
            return Ok((journal, Vec::new()));
        };
        if let Some(problem) = found.difference(identity) {
            return Err(SweepError::Other { path, problem });
        }
        let rows = journal.rows(&mut rest, cases);
        let whole = bytes.len() - rest.len();
        let cut = journal.file.set_len(whole as u64);
        cut.and_then(|()| journal.file.seek(SeekFrom::End(0)))
            .map_err(in_file)?;
        Ok((journal, rows))
    }

    /// Writes the beginning of a journal over an incomplete one.
    fn begin(&mut self, identity: &Identity, found: &[u8]) -> Result<(), SweepError> {
        if !MARK.as_bytes().starts_with(found) {
            return Err(SweepError::Other {
                path: self.path.clone(),
                problem: "no journal of a sweep of this version of moorline".to_string(),
            });
        }
        let start = self
            .file
            .set_len(0)
            .and_then(|()| self.file.seek(SeekFrom::Start(0)));
        let text = [MARK.as_bytes(), &framed(identity)].concat();
        start
            .and_then(|_| self.file.write_all(&text))
            .map_err(|error| self.failure(error))
    }

    /// Rows of the complete records; `rest` is then the bytes after them.
    fn rows(&mut self, rest: &mut &[u8], cases: &[Case]) -> Vec<Row> {
        let mut lists: Vec<Arc<Vec<Quantity>>> = Vec::new();
        let mut rows: Vec<Row> = Vec::new();
        while let Some((record, behind)) = first::<Record>(rest) {
            match record {
                Record::Quantities(list) => {
                    let list = Arc::new(list);
                    self.quantities.insert(list.clone(), lists.len());
                    lists.push(list);
                }
                Record::Case(number, results, notes) => {
                    let results = match results {
                        Ok((list, figures)) => lists.get(list).map(|quantities| {
                            let quantities = quantities.clone();
                            Ok(Results { quantities, figures })
                        }),
                        Err(reason) => Some(Err(reason)),
                    };
                    let case = number.checked_sub(1).and_then(|index| cases.get(index));
                    let (Some(results), Some(case)) = (results, case) else {
                        break;
                    };
                    rows.push(Row::of(case, results, notes));
                }
            }
            *rest = behind;
        }
        rows
    }

    /// Adds the row of a case that has ended.
    pub(crate) fn add(&mut self, row: &mut Row) -> Result<(), SweepError> {
        let mut text = Vec::new();
        let results = match &mut row.results {
            Ok(results) => {
                let list = self.list(results, &mut text);
                Ok((list, results.figures.clone()))
            }
            Err(reason) => Err(reason.clone()),
        };
        text.extend(framed(&Record::Case(row.case, results, row.notes.clone())));
        self.file.write_all(&text).map_err(|error| self.failure(error))
    }

    /// Number of the list of quantities of some results, which is shared with other rows; a new list is written.
    fn list(&mut self, results: &mut Results, text: &mut Vec<u8>) -> usize {
        if let Some((known, number)) = self.quantities.get_key_value(&results.quantities) {
            results.quantities = known.clone();
            return *number;
        }
        let number = self.quantities.len();
        self.quantities.insert(results.quantities.clone(), number);
        text.extend(framed(&Record::Quantities(results.quantities.to_vec())));
        number
    }

    fn failure(&self, source: io::Error) -> SweepError {
        let path = self.path.clone();
        SweepError::Output(OutputError::File { path, source })
    }
}

/// A record with its length and checksum.
fn framed(record: &impl Serialize) -> Vec<u8> {
    let sealed = sealed::seal(&[], record);
    let length = u32::try_from(sealed.len()).expect("a record is shorter than 4 GiB");
    [&length.to_le_bytes()[..], &sealed].concat()
}

/// The first record, and the bytes after it; `None` if the record is incomplete or damaged.
fn first<T: DeserializeOwned>(bytes: &[u8]) -> Option<(T, &[u8])> {
    let (length, rest) = bytes.split_at_checked(LENGTH)?;
    let length = u32::from_le_bytes(length.try_into().ok()?) as usize;
    let (sealed, rest) = rest.split_at_checked(length)?;
    Some((sealed::open(&[], sealed).ok()?, rest))
}
