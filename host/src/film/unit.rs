//! Pieces of work, and who may start which one.

use std::sync::{
    Condvar, Mutex, MutexGuard, PoisonError,
    atomic::{AtomicU64, Ordering},
};

/// The edge of a tile, in pixels.
pub const TILE: u32 = 32;

/// How many units may be under way or parked at once: it bounds the memory of buffers that wait for their turn.
pub const WINDOW: u64 = 256;

/// One sample of every pixel of a tile. Units are numbered sample by sample, and tile by tile (row by row) within a sample;
/// the film adds them up in that order, whoever made them and however they are divided into passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unit {
    /// Its number.
    pub index: u64,
    /// Which sample of every pixel.
    pub sample: u32,
    /// Left edge, in pixels of the crop window.
    pub x: u32,
    /// Upper edge, in pixels of the crop window.
    pub y: u32,
    /// At most [`TILE`].
    pub width: u32,
    /// At most [`TILE`].
    pub height: u32,
}

/// Hands out units in order.
#[derive(Debug)]
pub struct Dispatch {
    width: u32,
    height: u32,
    next: AtomicU64,
    settled: Mutex<Settled>,
    moved: Condvar,
}

#[derive(Debug)]
struct Settled {
    /// Every unit below this is on the film.
    below: u64,
    abandoned: bool,
}

impl Dispatch {
    /// For a window of that many pixels.
    pub fn new(width: u32, height: u32) -> Self {
        Self { width, height, next: AtomicU64::new(0), settled: Mutex::new(Settled { below: 0, abandoned: false }), moved: Condvar::new() }
    }

    /// How many units one sample of every pixel makes.
    pub fn units_per_sample(&self) -> u64 {
        u64::from(self.width.div_ceil(TILE)) * u64::from(self.height.div_ceil(TILE))
    }

    /// The next unit, as long as its sample's number is below `end`; waits while the oldest unfinished unit is [`WINDOW`] behind.
    /// `None` once there are no more, or after [`Dispatch::abandon`].
    pub fn claim(&self, end: u32) -> Option<Unit> {
        let end = u64::from(end) * self.units_per_sample();
        let more = |index| (index < end).then_some(index + 1);
        let index = self.next.fetch_update(Ordering::Relaxed, Ordering::Relaxed, more).ok()?;
        let mut settled = lock(&self.settled);
        while !settled.abandoned && index >= settled.below + WINDOW {
            settled = self.moved.wait(settled).unwrap_or_else(PoisonError::into_inner);
        }
        (!settled.abandoned).then(|| self.unit(index))
    }

    /// Notes that a unit, and so every one before it, is on the film.
    pub fn settle(&self, index: u64) {
        let mut settled = lock(&self.settled);
        settled.below = settled.below.max(index + 1);
        drop(settled);
        self.moved.notify_all();
    }

    /// No unit is handed out any more, and nobody waits.
    pub fn abandon(&self) {
        lock(&self.settled).abandoned = true;
        self.moved.notify_all();
    }

    fn unit(&self, index: u64) -> Unit {
        let columns = u64::from(self.width.div_ceil(TILE));
        let (sample, tile) = (index / self.units_per_sample(), index % self.units_per_sample());
        let (x, y) = ((tile % columns) as u32 * TILE, (tile / columns) as u32 * TILE);
        Unit { index, sample: sample as u32, x, y, width: TILE.min(self.width - x), height: TILE.min(self.height - y) }
    }
}

/// Locks, whatever happened to another thread that held the lock: every state behind these locks is whole between statements.
pub(super) fn lock<T: ?Sized>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pixel_comes_once_per_sample() {
        for (width, height) in [(1, 1), (32, 32), (65, 33), (8192, 1)] {
            let dispatch = Dispatch::new(width, height);
            for sample in 0..2 {
                let mut seen = vec![0; (width * height) as usize];
                while let Some(unit) = dispatch.claim(sample + 1) {
                    dispatch.settle(unit.index);
                    assert_eq!(unit.sample, sample);
                    for y in unit.y..unit.y + unit.height {
                        for x in unit.x..unit.x + unit.width {
                            seen[(y * width + x) as usize] += 1;
                        }
                    }
                }
                assert!(seen.iter().all(|&n| n == 1));
            }
        }
    }

    #[test]
    fn an_abandoned_dispatch_wakes_who_waits() {
        let dispatch = Dispatch::new(TILE, TILE);
        std::thread::scope(|scope| {
            let waiting = scope.spawn(|| (0..=WINDOW).map_while(|_| dispatch.claim(u32::MAX)).count());
            std::thread::sleep(std::time::Duration::from_millis(20));
            dispatch.abandon();
            assert_eq!(waiting.join().ok(), Some(WINDOW as usize));
        });
        assert_eq!(dispatch.claim(u32::MAX), None);
    }
}
