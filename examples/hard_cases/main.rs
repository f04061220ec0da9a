//! Figures of `docs/hard-cases.md`, and their numbers.
//!
//! `cargo run --release --example hard_cases -- docs/figures` runs all cases and draws a figure of each. For every run it prints the internal steps
//! per second, the error of the energy balance and the energy gain relative to the energy that flowed.

mod figures;
#[allow(dead_code)] // the tests use more than the figures
mod run;
#[allow(dead_code)] // the same
mod scenes;

use std::error::Error;
use std::path::Path;

use moorline::output::figures::compared::{Panel, compared};
use run::Run;

/// Result of a case: its charts, and its runs by name.
pub struct Page {
    /// Stem of the figure's file.
    pub stem: &'static str,
    /// Charts from top to bottom.
    pub panels: Vec<Panel>,
    /// Runs that the table lists.
    pub runs: Vec<(String, Run)>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1);
    if let Some(folder) = &folder {
        std::fs::create_dir_all(folder)?;
    }
    println!("run | integrator | steps for a second | peak [N] | ledger [-] | gain [-]");
    for draw in figures::ALL {
        let page = draw();
        for (name, run) in &page.runs {
            println!(
                "{}: {name} | {:?} | {:.0} | {:.4e} | {:.1e} | {:.1e}",
                page.stem,
                run.chosen,
                run.substeps_per_second(),
                run.peak(),
                run.ledger_error(),
                run.energy_gain()
            );
        }
        if let Some(folder) = &folder {
            let svg = compared(&page.panels).ok_or("a chart without a finite point")?;
            std::fs::write(Path::new(folder).join(format!("{}.svg", page.stem)), svg)?;
        }
    }
    Ok(())
}
