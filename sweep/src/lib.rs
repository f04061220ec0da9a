//! Load cases: a scene with other values of its keys in every case, run on all cores.
//!
//! [`cases`] reads a file of cases and checks each as a scene, [`run_case`] runs one, [`table()`] makes a table of rows; this is all that
//! another scheduler needs. [`Sweep`] runs all cases on this machine into a folder, with a journal: it can be killed at any moment, and a
//! later run continues to the same table, bit for bit.
//!
//! ```no_run
//! use moorline_decks::Supplement;
//! use moorline_sweep::{Base, cases, run_case, table};
//!
//! let base = Base::load("semi.toml".as_ref(), &Supplement::default())?;
//! let cases = cases(&base, "storms.csv".as_ref(), None)?;
//! let rows: Vec<_> = cases.iter().map(run_case).collect();
//! table(&rows).write("out".as_ref())?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]

mod case;
mod journal;
mod key;
mod kind;
mod row;
mod run;
mod sheet;
mod sweep;

use std::path::PathBuf;

use moorline::output::OutputError;

pub use case::{Base, Case, Key, cases};
pub use journal::JOURNAL;
pub use row::{Figures, Quantity, Results, Row, TABLE, Table, table};
pub use run::{SERIES, run_case, run_case_until};
pub use sweep::{Progress, Sweep, fingerprint, remarks, shortfalls};

/// Reason why a sweep cannot run in a folder.
#[derive(Debug, thiserror::Error)]
pub enum SweepError {
    /// The folder holds another sweep.
    #[error("{}: it holds {problem}: give another folder, or remove this file to begin anew", .path.display())]
    Other {
        /// The journal.
        path: PathBuf,
        /// The difference, in words.
        problem: String,
    },
    /// A file cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
}
