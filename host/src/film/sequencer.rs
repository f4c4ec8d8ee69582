//! Brings back into order what threads finish in any order.

use std::{collections::BTreeMap, sync::Mutex};

use super::unit::lock;

/// Applies items in the order of their numbers, from 0 and without gaps, one at a time.
#[derive(Debug)]
pub struct Sequencer<T> {
    queue: Mutex<Queue<T>>,
}

#[derive(Debug)]
struct Queue<T> {
    next: u64,
    parked: BTreeMap<u64, T>,
    /// Whether a thread is applying items; it takes what others park meanwhile.
    draining: bool,
}

impl<T> Sequencer<T> {
    /// Nothing came yet.
    pub fn new() -> Self {
        Self { queue: Mutex::new(Queue { next: 0, parked: BTreeMap::new(), draining: false }) }
    }

    /// Takes an item, and applies it and all that waited for it once their turn comes, in this thread or in the one
    /// that is at it already. When every thread that submitted has come back, everything up to the first gap is applied.
    pub fn submit(&self, index: u64, item: T, mut apply: impl FnMut(T)) {
        let mut queue = lock(&self.queue);
        queue.parked.insert(index, item);
        if queue.draining {
            return;
        }
        queue.draining = true;
        loop {
            let next = queue.next;
            let Some(item) = queue.parked.remove(&next) else {
                queue.draining = false;
                return;
            };
            queue.next += 1;
            drop(queue);
            apply(item);
            queue = lock(&self.queue);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn items_are_applied_in_order_whoever_brings_them() {
        let sequencer = Sequencer::new();
        let applied = Mutex::new(Vec::new());
        std::thread::scope(|scope| {
            for thread in 0..4_u64 {
                let (sequencer, applied) = (&sequencer, &applied);
                // Every thread brings its share backwards.
                scope.spawn(move || {
                    (0..250).rev().for_each(|i| sequencer.submit(i * 4 + thread, i * 4 + thread, |n| lock(applied).push(n)))
                });
            }
        });
        assert_eq!(*lock(&applied), (0..1000).collect::<Vec<_>>());
    }
}
