//! Threads that share work with the one that steps, and when they pay.
//!
//! Networks have nothing in common within a communication step: each goes its whole way over it on one thread, in the same operations in the
//! same order as on any other, and what is summed over networks is summed by their numbers afterwards. So results do not depend on
//! the number of threads, bit for bit. Each thread has its own networks, which its cache then holds from step to step; one that is done takes
//! over what others have not begun, so that a thread that wakes late, or is taken away, costs little.
//!
//! Threads are made when they are first needed, wait asleep, and have ended when their crew is dropped: a host that frees an
//! instance may unload the library. Where a host allows no threads everything is done on its own. A process that was forked has none of the
//! threads of the one that it is a copy of, and makes its own.
//!
//! A second thread pays where half of the work takes longer than to wake it and to wait for it, and where the machine has a core to spare.
//! So `auto` gives every thread [`WORTH`] of work at least, as told from the nodes and the internal steps; and every so often it times a few
//! steps on one thread against as many on all, in turns, and keeps to one where that is as fast ([`Pace`]).

use std::cell::Cell;
use std::process;
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::Instant;

use rayon_core::{ThreadPool, ThreadPoolBuilder};

use super::Choice;
use super::cost::{COMPONENT, node_time};
use crate::model::{Model, Network};
use crate::scene::{Integrator, Threads};

/// Runs work on a thread of its own and returns when it is done; work that is not run is not run at all.
pub type Aside = fn(&mut (dyn FnMut() + Send));

static ASIDE: OnceLock<Aside> = OnceLock::new();

/// Lets threads be made by a thread that [`Aside`] makes and ends: the standard library leaves something on a thread that makes another which
/// keeps a library loaded for as long as that thread lives, and a thread of a host may live longer than the instances.
pub fn make_threads_aside(aside: Aside) {
    // a second instance sets the same
    let _ = ASIDE.set(aside);
}

/// Name of the threads: a host that looks for its own knows these by it.
const THREAD_NAME: &str = "moorline";
/// Work that `auto` gives every thread at least [ns].
const WORTH: f64 = 25e3;

thread_local! {
    static HELPS: Cell<bool> = const { Cell::new(false) };
}

/// Whether this thread is one of a crew. Asks for nothing that a thread of a host would have to tidy up when it ends, by when the library may
/// be gone: its handle, [`thread::current`], is such a thing.
pub fn is_helper() -> bool {
    HELPS.get()
}

/// Makes this thread one of a crew, and does its work.
pub fn as_helper<T>(work: impl FnOnce() -> T) -> T {
    HELPS.set(true);
    work()
}

/// Threads beside the one that calls.
#[derive(Debug, Default)]
pub struct Crew {
    pool: Option<Pool>,
    /// Whether threads were asked for in vain.
    refused: bool,
}

/// A crew, and how many threads of it share some work.
#[derive(Debug)]
pub struct Hands<'a> {
    /// The crew.
    pub crew: &'a mut Crew,
    /// With the one that calls [-].
    pub threads: usize,
}

/// Threads that sleep until there is work.
#[derive(Debug)]
struct Pool {
    /// Present until it is dropped.
    threads: Option<ThreadPool>,
    handles: Vec<JoinHandle<()>>,
    /// The process whose threads they are.
    process: u32,
}

impl Clone for Crew {
    /// Another crew, whose threads are made when they are needed.
    fn clone(&self) -> Crew {
        Crew::default()
    }
}

impl Crew {
    /// Runs `lead` here and `help` with the number of every helper, from 0, and its scratch, each on the same thread every time; returns
    /// when all have.
    ///
    /// # Panics
    /// One of them panicked.
    pub fn run<S: Send>(
        &mut self,
        helpers: &[Mutex<S>],
        help: impl Fn(usize, &mut S) + Sync,
        lead: impl FnOnce(),
    ) {
        match self.muster(helpers.len()) {
            Some(threads) => {
                let help = &help;
                threads.in_place_scope(|scope| {
                    scope.spawn_broadcast(move |_, worker| {
                        let number = worker.index();
                        if let Some(helper) = helpers.get(number) {
                            help(number, &mut lock(helper));
                        }
                    });
                    lead();
                });
            }
            None => lead(),
        }
    }

    /// Makes the threads for so many helpers, where that is still to be done.
    #[inline]
    pub fn call(&mut self, helpers: usize) {
        if helpers > 0 {
            self.muster(helpers);
        }
    }

    /// So many threads or more; none where none are wanted, or to be had.
    fn muster(&mut self, size: usize) -> Option<&ThreadPool> {
        if size == 0 {
            return None;
        }
        let own = self.pool.as_ref().filter(|pool| pool.is_here());
        let has = own.map_or(0, |pool| pool.handles.len());
        if has < size && !self.refused {
            self.pool = None;
            self.pool = Pool::aside(size);
            self.refused = self.pool.is_none();
        }
        self.pool.as_ref()?.threads.as_ref()
    }
}

impl Pool {
    fn aside(size: usize) -> Option<Pool> {
        let Some(aside) = ASIDE.get() else {
            return Pool::new(size);
        };
        let mut pool = None;
        aside(&mut || pool = Pool::new(size));
        pool
    }

    fn new(size: usize) -> Option<Pool> {
        let mut pool = Pool {
            threads: None,
            handles: Vec::with_capacity(size),
            process: process::id(),
        };
        let handles = &mut pool.handles;
        let built = ThreadPoolBuilder::new()
            .num_threads(size)
            .spawn_handler(|worker| {
                let named = thread::Builder::new().name(THREAD_NAME.into());
                handles.push(named.spawn(|| as_helper(|| worker.run()))?);
                Ok(())
            })
            .build();
        pool.threads = built.ok();
        pool.threads.is_some().then_some(pool)
    }

    /// Whether this process has its threads.
    fn is_here(&self) -> bool {
        self.process == process::id()
    }
}

impl Drop for Pool {
    fn drop(&mut self) {
        if !self.is_here() {
            // no one is there to end; what they held is lost to this process
            std::mem::forget((self.threads.take(), std::mem::take(&mut self.handles)));
            return;
        }
        self.threads = None; // tells them to end
        for handle in self.handles.drain(..) {
            // one that panicked has ended too
            let _ = handle.join();
        }
    }
}

/// What is left to do. Everyone has a part, and takes from the ends of the others' when it is done.
#[derive(Debug)]
pub struct Queue<I>(Vec<Mutex<I>>);

impl<I: DoubleEndedIterator> Queue<I> {
    /// The part of each.
    pub fn new(parts: impl Iterator<Item = I>) -> Queue<I> {
        Queue(parts.map(Mutex::new).collect())
    }

    /// The next item for the owner of a part.
    pub fn take(&self, own: usize) -> Option<I::Item> {
        let first = || lock(self.0.get(own)?).next();
        let others = (1..self.0.len()).map(|step| (own + step) % self.0.len());
        let last = |other: usize| lock(&self.0[other]).next_back();
        first().or_else(|| others.map(last).find_map(|item| item))
    }
}

/// Scratch or work that no one else has at the moment; what a panic left of it is written anew.
pub fn lock<T>(slot: &Mutex<T>) -> MutexGuard<'_, T> {
    slot.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Steps on one thread that are timed against as many on all [-].
const TRIALS: u32 = 8;
/// Steps from one such comparison to the next [-].
const CYCLE: u32 = 600;
/// Time on all threads over that on one, above which one does [-].
const FASTER: f64 = 0.95;

/// Whether threads are as fast as was expected of them.
#[derive(Debug, Clone, Default)]
pub struct Pace {
    /// Steps since the last comparison began.
    count: u32,
    /// Time of the compared steps on one thread and on all, over their lengths [-].
    times: [f64; 2],
    /// Whether one thread was as fast.
    alone: bool,
}

/// How the next step goes.
#[derive(Debug, Clone, Copy)]
pub struct Turn {
    /// Threads [-].
    pub threads: usize,
    /// Whether it is for the pace to say.
    paced: bool,
    /// When it began, where it is timed.
    start: Option<Instant>,
}

impl Pace {
    /// Begins a step that so many threads are expected to be worth, or that is made on them whatever they are.
    pub fn turn(&self, expected: usize, is_given: bool) -> Turn {
        let paced = expected > 1 && !is_given;
        let compares = paced && self.count < 2 * TRIALS;
        let alone = match compares {
            true => self.count.is_multiple_of(2),
            false => paced && self.alone,
        };
        Turn {
            threads: if alone { 1 } else { expected },
            paced,
            start: compares.then(Instant::now),
        }
    }

    /// Takes note of a step that is over, which went a length [s].
    pub fn note(&mut self, turn: Turn, length: f64) {
        if !turn.paced {
            return;
        }
        if let Some(start) = turn.start {
            let time = start.elapsed().as_secs_f64() / length;
            self.times[self.count as usize % 2] += time;
        }
        self.count += 1;
        if self.count == 2 * TRIALS {
            let [alone, shared] = std::mem::take(&mut self.times);
            self.alone = shared > FASTER * alone;
        }
        self.count %= CYCLE;
    }
}

/// What there is to share, and among how many.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Labour {
    asked: Threads,
    /// Threads that the machine runs at once [-].
    hands: usize,
    /// Networks [-].
    parts: usize,
    /// Time for a second of all networks [ns/s].
    rate: f64,
    /// Time for one step of all networks [ns].
    least: f64,
    /// Lines that waves act on [-].
    heaving: usize,
    /// Time to ask the waves of all nodes once [ns].
    asking: f64,
}

impl Labour {
    /// Of a model whose networks are integrated as was chosen.
    pub fn new<'a>(model: &Model, choices: impl Iterator<Item = &'a Choice>) -> Labour {
        let asked = model.solver.threads;
        let parts = model.networks.len();
        let alone = parts < 2 && model.waves.is_none();
        let (mut rate, mut least) = (0.0, 0.0);
        for (network, choice) in model.networks.iter().zip(choices) {
            let step = node_time(model, network, choice.integrator) * nodes(model, network);
            least += step;
            if choice.integrator != Integrator::QuasiStatic {
                rate += step / choice.step_max;
            }
        }
        let heaving = model.lines.iter().filter(|line| line.heaves(model));
        let places = heaving.clone().map(|line| line.segment_count() + 1);
        let components = model.waves.as_ref().map_or(0, |w| w.components().len());
        Labour {
            asked,
            hands: match asked {
                Threads::Auto if !alone => thread::available_parallelism().map_or(1, usize::from),
                _ => 1,
            },
            parts,
            rate,
            least,
            heaving: heaving.count(),
            asking: COMPONENT * (places.sum::<usize>() * components) as f64,
        }
    }

    /// Whether the number of threads is given.
    pub fn is_given(&self) -> bool {
        self.asked != Threads::Auto
    }

    /// Threads for all networks over a time [s].
    pub fn over(&self, length: f64) -> usize {
        self.among(self.parts, (self.rate * length).max(self.least))
    }

    /// Threads to ask the waves of all lines.
    pub fn at_sea(&self) -> usize {
        self.among(self.heaving, self.asking)
    }

    /// Threads for so many parts that take a time [ns] together.
    fn among(&self, parts: usize, time: f64) -> usize {
        if parts < 2 {
            return 1;
        }
        let most = match self.asked {
            Threads::Number(number) => number,
            Threads::Auto => self.hands.min((time / WORTH) as usize),
        };
        most.min(parts).max(1)
    }

    /// How many threads share steps of a length [s], and why.
    pub fn in_words(&self, length: f64) -> String {
        let count = |threads: usize| match threads {
            1 => "one thread".to_string(),
            more => format!("{more} threads"),
        };
        let micro = |time: f64| format!("{:.0} µs", 1e-3 * time);
        let (steps, sea) = (self.over(length), self.at_sea());
        let shared = match self.asking > 0.0 && sea != steps {
            true => format!("{}, waves on {}", count(steps), count(sea)),
            false => count(steps),
        };
        if self.parts < 2 && self.heaving < 2 {
            return format!("{shared}: there is one system of lines");
        }
        if let Threads::Number(asked) = self.asked {
            return match steps.max(sea) < asked {
                true => format!(
                    "{shared}, of the {asked} given: there are {} systems of lines",
                    self.parts
                ),
                false => format!("{shared}, as given"),
            };
        }
        let time = micro((self.rate * length).max(self.least));
        let waves = match self.asking > 0.0 {
            true => format!(", and {} of waves now and then,", micro(self.asking)),
            false => String::new(),
        };
        format!(
            "{shared}: {} systems of lines with about {time} of work a communication step{waves} on a machine that runs {}; another one \
             pays from {} on{}",
            self.parts,
            count(self.hands),
            micro(WORTH),
            match steps.max(sea) {
                1 => "",
                _ => ", as long as steps are not found to be as fast on one",
            }
        )
    }
}

fn nodes(model: &Model, network: &Network) -> f64 {
    let lines = network.lines.iter();
    let count = lines.map(|&line| model.lines[line].segment_count() + 1);
    count.sum::<usize>() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::panic::{AssertUnwindSafe, catch_unwind};
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::time::Duration;

    /// Sums numbers with so many helpers; returns the sum, and who took part.
    fn summed(crew: &mut Crew, helpers: usize) -> (usize, usize) {
        let numbers: Vec<usize> = (1..=1000).collect();
        let queue = Queue::new(numbers.chunks(1000 / (helpers + 1) + 1).map(<[usize]>::iter));
        let sum = AtomicUsize::new(0);
        let work = |own: usize, came: &mut usize| {
            *came = 1;
            while let Some(item) = queue.take(own) {
                sum.fetch_add(*item, Ordering::Relaxed);
            }
        };
        let came: Vec<Mutex<usize>> = (0..helpers).map(|_| Mutex::new(0)).collect();
        let mut mine = 0;
        crew.run(
            &came,
            |number, came| work(number + 1, came),
            || work(0, &mut mine),
        );
        let theirs: usize = came.iter().map(|came| *lock(came)).sum();
        (sum.into_inner(), mine + theirs)
    }

    #[test]
    fn all_take_part_and_nothing_is_done_twice() {
        let mut crew = Crew::default();
        for helpers in [0, 1, 3, 2] {
            assert_eq!(summed(&mut crew, helpers), (500_500, helpers + 1));
        }
        assert_eq!(summed(&mut crew.clone(), 2), (500_500, 3));
    }

    #[test]
    fn no_thread_is_made_before_it_is_needed_and_none_lives_on() {
        let mut crew = Crew::default();
        summed(&mut crew, 0);
        assert!(crew.pool.is_none());
        let here = thread::current().id();
        let helper = [Mutex::new(here)];
        let help = |_, helper: &mut thread::ThreadId| {
            assert_eq!(thread::current().name(), Some(THREAD_NAME));
            assert!(is_helper());
            *helper = thread::current().id();
        };
        crew.run(&helper, help, || ());
        assert_ne!(*lock(&helper[0]), here);
        assert!(!is_helper());
        let pool = crew.pool.as_mut().expect("a pool");
        let handle = pool.handles.pop().expect("a thread");
        assert!(!handle.is_finished());
        drop(crew);
        handle.join().expect("it has been told to end");
    }

    #[test]
    fn a_panic_of_a_helper_arrives_and_the_crew_works_on() {
        let mut crew = Crew::default();
        let helpers = [(); 2].map(Mutex::new);
        let run = AssertUnwindSafe(|| crew.run(&helpers, |_, ()| panic!("lost"), || ()));
        let payload = catch_unwind(run).expect_err("a panic");
        assert_eq!(payload.downcast_ref::<&str>(), Some(&"lost"));
        assert_eq!(summed(&mut crew, 2), (500_500, 3));
    }

    #[test]
    fn threads_that_do_not_make_steps_faster_are_left_alone_until_the_next_comparison() {
        let compared = |shared: f64| {
            let mut pace = Pace::default();
            for step in 0..2 * TRIALS as usize {
                let mut turn = pace.turn(4, false);
                assert_eq!(turn.threads, [1, 4][step % 2]);
                let ago = Duration::from_secs_f64([1.0, shared][step % 2]);
                turn.start = turn.start.and_then(|now| now.checked_sub(ago));
                pace.note(turn, 0.1);
            }
            let kept = pace.turn(4, false).threads;
            for _ in 2 * TRIALS..CYCLE {
                let turn = pace.turn(4, false);
                assert_eq!((turn.threads, turn.start), (kept, None));
                pace.note(turn, 0.1);
                pace.note(pace.turn(4, true), 0.1); // no part of it
            }
            assert!(pace.turn(4, false).start.is_some());
            kept
        };
        assert_eq!([0.6, 0.99, 3.0].map(compared), [4, 1, 1]);
    }

    #[test]
    fn threads_are_as_many_as_the_work_is_worth() {
        let labour = Labour {
            asked: Threads::Auto,
            hands: 4,
            parts: 12,
            rate: 1e7,
            least: 1e4,
            heaving: 0,
            asking: 0.0,
        };
        let lengths = [1e-4, 2.5e-3, 5.1e-3, 7.6e-3, 1.0];
        assert_eq!(lengths.map(|length| labour.over(length)), [1, 1, 2, 3, 4]);
        assert_eq!(labour.at_sea(), 1);
        let few = Labour { parts: 2, ..labour };
        assert_eq!(few.over(1.0), 2);
        let asked = Labour {
            asked: Threads::Number(3),
            ..labour
        };
        assert_eq!(asked.over(1e-4), 3);
    }
}
