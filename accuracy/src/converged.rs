//! Converged solution of a scene, and its distance from convergence.
//!
//! Meshes are refined step by step. The mesh closest to its predecessor is selected, and their distance is its uncertainty. Under a well-posed law,
//! this is the finest mesh. If damping acts in compression, a slack line without bending stiffness is ill posed: its short waves grow, and meshes
//! beyond a certain fineness diverge again. A seabed softened with the mesh and one as given have the same limit and converge to it at different
//! rates; the better of the two is used.

use moorline::scene::Scene;

use crate::errors::{Errors, Histories, Judge, Metric};
use crate::ladder::{self, Setting};
use crate::timed::{Timed, Trial};
use crate::{StudyError, judge};

/// The converged solution.
#[derive(Debug, Clone)]
pub(crate) struct Converged {
    pub setting: Setting,
    pub fine: Timed,
    /// Distance from the previous mesh.
    pub uncertainty: Errors,
    judge: Judge,
}

/// Sequence of settings, run one by one.
struct Sequence {
    rest: std::vec::IntoIter<Setting>,
    before: Option<Timed>,
    best: Option<Converged>,
}

impl Converged {
    /// Finds the converged solution with the first applicable family of settings.
    pub(crate) fn find(name: &str, scene: &Scene) -> Result<Converged, StudyError> {
        let name = || name.to_string();
        let mut reason = String::new();
        for family in ladder::converged(scene, scene.shortest_period()) {
            match followed(scene, family) {
                Ok(Some(best)) => return Ok(best),
                Ok(None) => return Err(StudyError::AtRest { name: name() }),
                Err(said) => reason = said,
            }
        }
        Err(StudyError::NotConverged { name: name(), reason })
    }

    /// Errors of histories against this solution.
    pub(crate) fn errors(&self, histories: &Histories) -> Errors {
        self.judge.errors(histories, &self.fine.histories)
    }

    /// Measure of convergence; the least is best [-].
    fn doubt(&self) -> f64 {
        self.uncertainty.of(Metric::Rms) + self.uncertainty.of(Metric::Position)
    }
}

/// Runs two meshes of every sequence of a family, then the rest of the best sequence; returns the best solution. `None` if nothing moves.
fn followed(scene: &Scene, family: Vec<Vec<Setting>>) -> Result<Option<Converged>, String> {
    let mut reason = String::new();
    let mut sequences: Vec<Sequence> = Vec::new();
    for settings in family {
        let mut sequence = Sequence {
            rest: settings.into_iter(),
            before: None,
            best: None,
        };
        match sequence.refine(scene).and_then(|()| sequence.refine(scene)) {
            Ok(()) => sequences.push(sequence),
            Err(said) => reason = said,
        }
        if sequences.iter().any(Sequence::rests) {
            return Ok(None);
        }
    }
    let doubt = |sequence: &Sequence| sequence.best.as_ref().map_or(f64::NAN, Converged::doubt);
    let better = sequences.into_iter().min_by(|a, b| doubt(a).total_cmp(&doubt(b)));
    let Some(mut sequence) = better else {
        return Err(reason);
    };
    // If a mesh is too fine to run, the coarser ones remain.
    while sequence.rest.len() > 0 && sequence.refine(scene).is_ok() {}
    Ok(sequence.best)
}

impl Sequence {
    /// Runs the next setting and keeps the result if it is closer to its predecessor than any earlier one.
    fn refine(&mut self, scene: &Scene) -> Result<(), String> {
        let Some(setting) = self.rest.next() else {
            return Ok(());
        };
        let (fine, _) = Trial::exact(scene, &setting)?.recorded()?;
        if let Some(coarse) = self.before.replace(fine.clone()) {
            let judge = judge(scene, &fine.histories);
            let one = Converged {
                setting,
                uncertainty: judge.uncertainty(&coarse.histories, &fine.histories),
                fine,
                judge,
            };
            let best = self.best.as_ref();
            if best.is_none_or(|best| one.doubt() < best.doubt()) {
                self.best = Some(one);
            }
        }
        Ok(())
    }

    /// Returns whether nothing moves in the last run.
    fn rests(&self) -> bool {
        self.before.as_ref().is_some_and(|timed| !timed.moves())
    }
}
