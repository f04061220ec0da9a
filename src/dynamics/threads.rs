//! Threads that share the networks of a communication step.
//!
//! Networks are independent within a communication step: each advances on one thread, by the same operations in the same order for any
//! number of threads, and sums over networks are formed afterwards in their order. Results are therefore bit-identical on any number
//! of threads. Each thread gets an equal, contiguous part of the networks.
//!
//! Worker threads are used if each thread has at least [`WORTH`] of work; the work of a step is estimated from its
//! nodes and internal steps.
//!
//! Worker threads are created on first use, sleep between steps and are joined when the pool is dropped, so that a host may unload the
//! library after it has freed its instances. Where the system grants no threads, all work is done on the calling thread. A forked process
//! has none of its parent's threads and creates its own.

use std::cell::Cell;
use std::process;
use std::sync::OnceLock;
use std::thread::{self, JoinHandle};

use rayon_core::ThreadPoolBuilder;

use super::Choice;
use super::cost::{COMPONENT, node_time};
use crate::model::{Model, Network};
use crate::scene::{Integrator, Threads};

/// Function that runs work on a new thread and returns when it is done.
pub type Aside = fn(&mut (dyn FnMut() + Send));

static ASIDE: OnceLock<Aside> = OnceLock::new();

/// Makes a thread that `aside` starts and joins create all worker threads. The standard library leaves a destructor on every
/// thread that creates another, which keeps a shared library mapped as long as that thread lives; a thread of the host may outlive all
/// instances.
pub fn make_threads_aside(aside: Aside) {
    let _ = ASIDE.set(aside); // every instance sets the same
}

/// Name of the worker threads, which distinguishes them from those of the host.
const THREAD_NAME: &str = "moorline";
/// Work per thread from which `auto` adds a thread [ns].
const WORTH: f64 = 25e3;

thread_local! {
    static IS_WORKER: Cell<bool> = const { Cell::new(false) };
}

/// Returns whether the current thread is a worker thread. Unlike [`thread::current`], this needs no destructor on the thread.
pub fn is_worker() -> bool {
    IS_WORKER.get()
}

/// Marks the current thread as a worker thread and runs `work`.
pub fn as_worker<T>(work: impl FnOnce() -> T) -> T {
    IS_WORKER.set(true);
    work()
}

/// Worker threads in addition to the calling one, created on first use. A clone has none yet.
#[derive(Debug, Default)]
pub(super) struct ThreadPool {
    workers: Option<Workers>,
    /// True if the system refused to create threads.
    refused: bool,
}

impl Clone for ThreadPool {
    fn clone(&self) -> ThreadPool {
        ThreadPool::default()
    }
}

impl ThreadPool {
    /// Splits `items` into as many equal parts as there are `scratch` values and calls `work` on each part with the index of its first item:
    /// the first part on this thread, the others on workers. Returns when all parts are done.
    ///
    /// # Panics
    /// A call of `work` panicked.
    pub(super) fn share<T, S>(
        &mut self,
        items: &mut [T],
        scratch: &mut [S],
        work: impl Fn(usize, &mut [T], &mut S) + Sync,
    ) where
        T: Send,
        S: Send,
    {
        let size = items.len().div_ceil(scratch.len()).max(1);
        let mut parts = items.chunks_mut(size).zip(scratch).enumerate();
        let first = parts.next();
        let lead = |part: Option<(usize, (&mut [T], &mut S))>| {
            if let Some((number, (items, scratch))) = part {
                work(number * size, items, scratch);
            }
        };
        let Some(workers) = self.workers(parts.len()) else {
            lead(first);
            parts.for_each(|part| lead(Some(part)));
            return;
        };
        let lead = &lead;
        workers.in_place_scope(|scope| {
            for part in parts {
                scope.spawn(move |_| lead(Some(part)));
            }
            lead(first);
        });
    }

    /// Returns at least `count` workers; `None` if `count` is 0 or the system grants none.
    fn workers(&mut self, count: usize) -> Option<&rayon_core::ThreadPool> {
        if count == 0 {
            return None;
        }
        let own = self.workers.as_ref().filter(|workers| workers.is_here());
        let present = own.map_or(0, |workers| workers.handles.len());
        if present < count && !self.refused {
            self.workers = None; // joins the smaller pool
            self.workers = Workers::aside(count);
            self.refused = self.workers.is_none();
        }
        self.workers.as_ref()?.pool.as_ref()
    }
}

#[derive(Debug)]
struct Workers {
    /// `Some` until the workers are dropped.
    pool: Option<rayon_core::ThreadPool>,
    handles: Vec<JoinHandle<()>>,
    /// Process that the threads belong to.
    process: u32,
}

impl Workers {
    fn aside(count: usize) -> Option<Workers> {
        let Some(aside) = ASIDE.get() else {
            return Workers::new(count);
        };
        let mut workers = None;
        aside(&mut || workers = Workers::new(count));
        workers
    }

    fn new(count: usize) -> Option<Workers> {
        let mut handles = Vec::with_capacity(count);
        let pool = ThreadPoolBuilder::new()
            .num_threads(count)
            .spawn_handler(|worker| {
                let named = thread::Builder::new().name(THREAD_NAME.into());
                handles.push(named.spawn(|| as_worker(|| worker.run()))?);
                Ok(())
            })
            .build()
            .ok();
        let workers = Workers {
            pool,
            handles,
            process: process::id(),
        };
        workers.pool.is_some().then_some(workers)
    }

    fn is_here(&self) -> bool {
        self.process == process::id()
    }
}

impl Drop for Workers {
    fn drop(&mut self) {
        if !self.is_here() {
            // a forked process has no threads to join
            std::mem::forget((self.pool.take(), std::mem::take(&mut self.handles)));
            return;
        }
        self.pool = None; // ends the workers
        for handle in self.handles.drain(..) {
            let _ = handle.join(); // a thread that panicked has ended too
        }
    }
}

/// Estimated work of a model's steps, from which the number of threads is chosen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct WorkEstimate {
    asked: Threads,
    /// Number of threads that the machine runs at once [-].
    available: usize,
    networks: usize,
    /// Computing time per second of motion, for all networks [ns/s].
    rate: f64,
    /// Computing time of one internal step of all networks [ns].
    least: f64,
    /// Number of lines on which waves act [-].
    lines_in_waves: usize,
    /// Time to sample the waves at all nodes once [ns].
    sampling: f64,
}

impl WorkEstimate {
    /// Estimates the work of a model whose networks use the integrators chosen.
    pub(super) fn new<'a>(model: &Model, choices: impl Iterator<Item = &'a Choice>) -> WorkEstimate {
        let asked = model.solver.threads;
        let networks = model.networks.len();
        let shareable = networks > 1 || model.waves.is_some();
        let (mut rate, mut least) = (0.0, 0.0);
        for (network, choice) in model.networks.iter().zip(choices) {
            let step = node_time(model, network, choice.integrator) * node_count(model, network);
            least += step;
            if choice.integrator != Integrator::QuasiStatic {
                rate += step / choice.step_max;
            }
        }
        let in_waves = model.lines.iter().filter(|line| line.heaves(model));
        let nodes = in_waves.clone().map(|line| line.segment_count() + 1);
        let components = model.waves.as_ref().map_or(0, |w| w.components().len());
        WorkEstimate {
            asked,
            available: match asked {
                Threads::Auto if shareable => thread::available_parallelism().map_or(1, usize::from),
                _ => 1,
            },
            networks,
            rate,
            least,
            lines_in_waves: in_waves.count(),
            sampling: COMPONENT * (nodes.sum::<usize>() * components) as f64,
        }
    }

    /// Returns the number of threads for a communication step of `length` [s].
    pub(super) fn threads_for(&self, length: f64) -> usize {
        self.threads(self.networks, (self.rate * length).max(self.least))
    }

    pub(super) fn threads_for_waves(&self) -> usize {
        self.threads(self.lines_in_waves, self.sampling)
    }

    /// Returns the number of threads for `parts` parts that take `time` [ns] in total.
    fn threads(&self, parts: usize, time: f64) -> usize {
        if parts < 2 {
            return 1;
        }
        let most = match self.asked {
            Threads::Number(number) => number,
            Threads::Auto => self.available.min((time / WORTH) as usize),
        };
        most.min(parts).max(1)
    }

    /// Describes the number of threads for communication steps of `length` [s], with the reason.
    pub(super) fn describe(&self, length: f64) -> String {
        let count = |threads: usize| match threads {
            1 => "one thread".to_string(),
            more => format!("{more} threads"),
        };
        let micro = |time: f64| format!("{:.0} µs", 1e-3 * time);
        let (steps, waves) = (self.threads_for(length), self.threads_for_waves());
        let shared = match self.sampling > 0.0 && waves != steps {
            true => format!("{}, waves on {}", count(steps), count(waves)),
            false => count(steps),
        };
        if self.networks < 2 && self.lines_in_waves < 2 {
            return format!("{shared}, since there is one network of lines");
        }
        if let Threads::Number(asked) = self.asked {
            return match steps.max(waves) < asked {
                true => format!(
                    "{shared} of the {asked} given, since there are {} networks of lines",
                    self.networks
                ),
                false => format!("{shared}, as given"),
            };
        }
        let time = micro((self.rate * length).max(self.least));
        let sampling = match self.sampling > 0.0 {
            true => format!(" and {} per sample of the waves", micro(self.sampling)),
            false => String::new(),
        };
        format!(
            "{shared}: {} networks of lines take about {time} per communication step{sampling}; this machine has {}, and one is used for every \
             {} of work",
            self.networks,
            count(self.available),
            micro(WORTH),
        )
    }
}

fn node_count(model: &Model, network: &Network) -> f64 {
    let lines = network.lines.iter();
    let count = lines.map(|&line| model.lines[line].segment_count() + 1);
    count.sum::<usize>() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::panic::{AssertUnwindSafe, catch_unwind};

    /// Doubles 1000 numbers on the pool, checks each of them, and returns the thread that ran each part.
    fn doubled(pool: &mut ThreadPool, threads: usize) -> Vec<Option<thread::ThreadId>> {
        let mut numbers: Vec<usize> = (0..1000).collect();
        let mut workers = vec![None; threads];
        pool.share(&mut numbers, &mut workers, |first, part, worker| {
            assert_eq!(part[0], first);
            part.iter_mut().for_each(|number| *number *= 2);
            assert_eq!(is_worker(), first > 0);
            *worker = Some(thread::current().id());
        });
        assert!(numbers.iter().enumerate().all(|(i, number)| *number == 2 * i));
        workers
    }

    #[test]
    fn all_parts_are_done_once_and_the_first_on_the_calling_thread() {
        let mut pool = ThreadPool::default();
        for threads in [1, 2, 4, 3] {
            let workers = doubled(&mut pool, threads);
            assert_eq!(workers[0], Some(thread::current().id()));
            assert!(workers.iter().all(Option::is_some));
        }
        assert!(doubled(&mut pool.clone(), 3).iter().all(Option::is_some));
    }

    #[test]
    fn no_thread_is_created_before_it_is_needed_and_none_outlives_the_pool() {
        let mut pool = ThreadPool::default();
        doubled(&mut pool, 1);
        assert!(pool.workers.is_none());
        doubled(&mut pool, 2);
        let workers = pool.workers.as_mut().expect("a worker");
        let handle = workers.handles.pop().expect("a thread");
        assert_eq!(handle.thread().name(), Some(THREAD_NAME));
        assert!(!handle.is_finished());
        drop(pool);
        handle.join().expect("it has been told to end");
    }

    #[test]
    fn a_panic_of_a_worker_arrives_and_the_pool_works_on() {
        let mut pool = ThreadPool::default();
        let fail = |first: usize, _: &mut [usize], (): &mut ()| assert!(first == 0, "lost");
        let run = AssertUnwindSafe(|| pool.share(&mut [0, 1], &mut [(); 2], fail));
        let payload = catch_unwind(run).expect_err("a panic");
        assert_eq!(payload.downcast_ref::<&str>(), Some(&"lost"));
        doubled(&mut pool, 3);
    }

    #[test]
    fn threads_are_as_many_as_the_work_is_worth() {
        let estimate = WorkEstimate {
            asked: Threads::Auto,
            available: 4,
            networks: 12,
            rate: 1e7,
            least: 1e4,
            lines_in_waves: 0,
            sampling: 0.0,
        };
        let lengths = [1e-4, 2.5e-3, 5.1e-3, 7.6e-3, 1.0];
        assert_eq!(
            lengths.map(|length| estimate.threads_for(length)),
            [1, 1, 2, 3, 4]
        );
        assert_eq!(estimate.threads_for_waves(), 1);
        let few = WorkEstimate {
            networks: 2,
            ..estimate
        };
        assert_eq!(few.threads_for(1.0), 2);
        let asked = WorkEstimate {
            asked: Threads::Number(3),
            ..estimate
        };
        assert_eq!(asked.threads_for(1e-4), 3);
    }
}
