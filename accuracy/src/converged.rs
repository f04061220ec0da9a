//! Converged solution of a scene, and its distance from convergence.
//!
//! Meshes are refined step by step, and the one closest to the mesh before it is taken; their distance is its
//! uncertainty. Under a well-posed law that is the finest. Where damping acts in compression a slack line without
//! bending stiffness is ill posed: its short waves grow, and meshes beyond some fineness diverge again. A seabed
//! softened with the mesh and one as given have the same limit and converge to it at different rates; the better of
//! the two is used.

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
    /// Distance from the mesh before.
    pub uncertainty: Errors,
    judge: Judge,
}

/// A sequence of settings on its way.
struct Sequence {
    rest: std::vec::IntoIter<Setting>,
    before: Option<Timed>,
    best: Option<Converged>,
}

impl Converged {
    /// Finds it by the first applicable family of settings.
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

/// The best of a family: two meshes of every sequence, then the rest of the better one. `None` where nothing moves.
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
    // A mesh too fine to run leaves the ones before it.
    while sequence.rest.len() > 0 && sequence.refine(scene).is_ok() {}
    Ok(sequence.best)
}

impl Sequence {
    /// Runs the next setting and keeps it if it lies closer to its forerunner than any before.
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
