//! Many designs at once, their rows in order.

use std::collections::BTreeMap;
use std::io;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc;

use super::{Row, Sweep};

/// Rows that may be ahead of the one waited for, per thread: a slow design does not hold up the others for long, and a lost process
/// loses little.
const AHEAD: u64 = 32;

impl Sweep {
    /// Computes some designs (numbers from 0) on so many threads, all of the machine's for 0, and hands the rows on in their order. Stops
    /// early, with the rows handed on complete up to some place, when `stop` is set or `on_row` fails. Gives the number of rows.
    ///
    /// # Errors
    /// That of `on_row`, or of starting threads.
    pub fn run(
        &self,
        designs: Range<u64>,
        threads: usize,
        stop: &AtomicBool,
        on_row: &mut dyn FnMut(Row) -> io::Result<()>,
    ) -> io::Result<u64> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(io::Error::other)?;
        let ahead = AHEAD * pool.current_num_threads() as u64;
        let failed = AtomicBool::new(false);
        let halt = || stop.load(Ordering::Relaxed) || failed.load(Ordering::Relaxed);
        let (sender, receiver) = mpsc::channel();
        pool.in_place_scope_fifo(|scope| {
            let mut waiting = BTreeMap::new();
            let (mut sent, mut received, mut next) = (designs.start, designs.start, designs.start);
            let mut result = Ok(());
            loop {
                while sent < designs.end && sent - next < ahead && !halt() {
                    let (sender, design, halt) = (sender.clone(), sent, &halt);
                    scope.spawn_fifo(move |_| {
                        let row = catch_unwind(AssertUnwindSafe(|| if halt() { None } else { self.row(design, halt) }));
                        // The receiver lives as long as the scope.
                        let _ = sender.send((design, row));
                    });
                    sent += 1;
                }
                if received == sent {
                    return result.map(|()| next - designs.start);
                }
                let Ok((design, row)) = receiver.recv() else { return result.map(|()| next - designs.start) };
                received += 1;
                waiting.insert(design, row.unwrap_or_else(|panic| resume_unwind(panic)));
                while !failed.load(Ordering::Relaxed)
                    && let Some(Some(row)) = waiting.remove(&next)
                {
                    result = on_row(row);
                    failed.store(result.is_err(), Ordering::Relaxed);
                    next += u64::from(result.is_ok());
                }
            }
        })
    }
}
