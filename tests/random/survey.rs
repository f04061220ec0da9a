//! Runs many scenes on two threads and counts their outcomes.

use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::{Config, RngAlgorithm, TestCaseError, TestError, TestRng, TestRunner};

use crate::dice::{Tape, TapeTree, Tapes};
use crate::features;
use crate::run::{Account, Case, Fate, run};

/// Threads.
const THREADS: usize = 2;
/// Maximum number of runs to shrink a failing scene [-].
const SHRINKS_MAX: u32 = 200;
/// Greatest error of an energy balance that counts as closed, relative to the energy that it counts [-].
pub const CLOSED: f64 = 0.02;

fn runner(number: usize) -> TestRunner {
    let config = Config {
        failure_persistence: None,
        max_shrink_iters: SHRINKS_MAX,
        ..Config::default()
    };
    let mut seed = [0; 32];
    seed[..8].copy_from_slice(&(number as u64).to_le_bytes());
    TestRunner::new_with_rng(config, TestRng::from_seed(RngAlgorithm::ChaCha, &seed))
}

fn tree(number: usize) -> TapeTree {
    let tree = Tapes.new_tree(&mut runner(number));
    tree.expect("tapes are always drawn")
}

/// Returns the tape with a number, which is always the same.
pub fn tape(number: usize) -> Tape {
    tree(number).current()
}

/// Returns the case with a number, which is always the same.
pub fn case(number: usize) -> Case {
    Case::of(&tape(number))
}

/// Returns a simpler case that breaks a claim as the case with this number does, and the claim.
pub fn shrunk(number: usize) -> Option<(Case, String)> {
    let hold = |tape| match run(&Case::of(&tape)) {
        Ok(_) => Ok(()),
        Err(claim) => Err(TestCaseError::fail(claim)),
    };
    match runner(number).run_one(tree(number), hold) {
        Err(TestError::Fail(claim, tape)) => Some((Case::of(&tape), claim.message().to_string())),
        _ => None,
    }
}

/// Energy balance of a scene.
#[derive(Debug, Clone, Copy)]
pub struct Closing {
    pub scene: usize,
    /// Error of the energy balance, relative to the energy that it counts [-].
    pub imbalance: f64,
    /// Energy added by algorithmic dissipation, relative to the same energy [-].
    pub created: f64,
}

impl Closing {
    /// Returns whether the energy balance closes.
    pub fn close(&self) -> bool {
        self.imbalance.abs() <= CLOSED
    }

    /// Returns whether the energy balance closes and algorithmic dissipation adds no significant energy.
    pub fn are_sound(&self) -> bool {
        self.close() && self.created <= CLOSED
    }
}

/// Outcomes of scenes.
#[derive(Debug, Default)]
pub struct Survey {
    /// Number of scenes [-].
    pub scenes: usize,
    /// Number of scenes by fate [-].
    pub fates: BTreeMap<&'static str, usize>,
    /// By feature: number of scenes that ran for the whole span or to their cost limit, and number of scenes [-].
    pub features: BTreeMap<&'static str, [usize; 2]>,
    /// Energy balances, by integrator.
    pub balances: BTreeMap<String, Vec<Closing>>,
    /// Scenes that break a claim, with the claim.
    pub broken: Vec<(usize, String)>,
    /// Number of scenes by the reason why they were not run to the end [-].
    pub reasons: BTreeMap<String, usize>,
    /// Scenes in which a step failed, with the reason.
    pub stopped: Vec<(usize, String)>,
    /// Work of the most expensive communication step [-], and its scene.
    pub dearest: (f64, usize),
}

impl Survey {
    /// Runs the scenes with these numbers.
    pub fn of(numbers: Range<usize>) -> Survey {
        let survey = Mutex::new(Survey::default());
        let (next, numbers_end) = (AtomicUsize::new(numbers.start), numbers.end);
        let work = || {
            let numbers = std::iter::from_fn(|| Some(next.fetch_add(1, Ordering::Relaxed)));
            for number in numbers.take_while(|number| *number < numbers_end) {
                let case = case(number);
                let result = run(&case);
                let mut survey = survey.lock().expect("no thread panics while it counts");
                survey.count(number, &case, result);
            }
        };
        thread::scope(|scope| {
            for _ in 0..THREADS {
                scope.spawn(work);
            }
        });
        survey.into_inner().expect("no thread panics while it counts")
    }

    fn count(&mut self, number: usize, case: &Case, result: Result<Account, String>) {
        self.scenes += 1;
        let account = match result {
            Ok(account) => account,
            Err(claim) => return self.broken.push((number, claim)),
        };
        let balances = Closing {
            scene: number,
            imbalance: account.imbalance,
            created: account.created,
        };
        let (fate, reason) = match account.fate {
            Fate::Ran => ("ran", None),
            Fate::Costly => ("too dear", None),
            Fate::Refused(reason) => ("refused", Some(reason)),
            Fate::Unsolved(reason) => ("no equilibrium", Some(reason)),
            Fate::Stopped(reason) => ("stopped", Some(reason)),
        };
        *self.fates.entry(fate).or_default() += 1;
        if let (Some(reason), "stopped") = (&reason, fate) {
            self.stopped.push((number, reason.clone()));
        }
        if let Some(reason) = &reason {
            *self.reasons.entry(kind_of(reason)).or_default() += 1;
        }
        for feature in features::of(case) {
            let [ran, all] = self.features.entry(feature).or_default();
            *ran += usize::from(reason.is_none());
            *all += 1;
        }
        if reason.is_none() && account.time > 0.0 {
            let mut names = account.integrators;
            names.sort();
            names.dedup();
            let name = match &names[..] {
                [name] => name,
                _ => "several",
            };
            let steps = match (features::jumps(&case.scene), case.drive.is_irregular()) {
                (true, _) => "jumps",
                (_, true) => "irregular steps",
                _ => "equal steps",
            };
            let name = format!("{name}, {steps}");
            self.balances.entry(name).or_default().push(balances);
        }
        if account.dearest > self.dearest.0 {
            self.dearest = (account.dearest, number);
        }
    }

    /// Share of scenes with a fate [-].
    pub fn share(&self, fate: &str) -> f64 {
        self.fates.get(fate).copied().unwrap_or(0) as f64 / self.scenes as f64
    }

    /// Numbers of energy balances of an integrator: closed, sound, and all [-].
    pub fn closed(&self, integrator: &str) -> [f64; 3] {
        let balances = self.balances.get(integrator).map_or(&[][..], Vec::as_slice);
        let count = |which: fn(&Closing) -> bool| balances.iter().filter(|balance| which(balance)).count();
        [count(Closing::close), count(Closing::are_sound), balances.len()].map(|count| count as f64)
    }

    /// Greatest error of the energy balances of an integrator, over all kinds of communication steps [-].
    pub fn worst(&self, integrator: &str) -> f64 {
        let found = self.balances.iter();
        let balances = found
            .filter(|(name, _)| name.starts_with(integrator))
            .flat_map(|(_, balances)| balances);
        balances
            .map(|balance| balance.imbalance.abs().max(balance.created))
            .fold(0.0, f64::max)
    }
}

/// Returns a reason without its numbers and names.
fn kind_of(reason: &str) -> String {
    let words = reason.split([' ', '"']);
    let plain = words.filter(|word| !word.contains(|c: char| c.is_ascii_digit()));
    plain
        .filter(|word| !word.is_empty())
        .take(12)
        .collect::<Vec<_>>()
        .join(" ")
}

impl fmt::Display for Survey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{} scenes: {:?}", self.scenes, self.fates)?;
        for (reason, count) in &self.reasons {
            writeln!(f, "{count:6} {reason}")?;
        }
        writeln!(f, "run, of all, with")?;
        for (feature, [ran, all]) in &self.features {
            writeln!(f, "{ran:6} {all:6} {feature}")?;
        }
        for (integrator, balances) in &self.balances {
            let mut balances = balances.clone();
            balances.sort_by(|a, b| a.imbalance.abs().total_cmp(&b.imbalance.abs()));
            let at = |share: f64| balances[(share * (balances.len() - 1) as f64) as usize];
            let (median, most, worst) = (at(0.5), at(0.9), at(1.0));
            let [closed, sound, all] = self.closed(integrator);
            writeln!(
                f,
                "{integrator}: {all} balances, {:.1} % close within {CLOSED}, {:.1} % with nothing brought; half of them within {:.1e}, \
                 nine in ten within {:.1e}, worst {:+.1e} in scene {}",
                100.0 * closed / all,
                100.0 * sound / all,
                median.imbalance.abs(),
                most.imbalance.abs(),
                worst.imbalance,
                worst.scene
            )?;
        }
        for (integrator, balances) in &self.balances {
            let mut open: Vec<_> = balances.iter().filter(|balance| !balance.are_sound()).collect();
            open.sort_by_key(|balance| balance.scene);
            writeln!(f, "{integrator}: open in, and brought")?;
            for balance in open {
                let (error, brought) = (100.0 * balance.imbalance, 100.0 * balance.created.max(0.0));
                write!(f, " {} ({error:+.1} %, {brought:.1} %)", balance.scene)?;
            }
            writeln!(f)?;
        }
        for (scene, reason) in &self.stopped {
            writeln!(f, "{scene} stopped: {reason}")?;
        }
        writeln!(
            f,
            "dearest communication step: {:.1e} node steps in scene {}",
            self.dearest.0, self.dearest.1
        )
    }
}
