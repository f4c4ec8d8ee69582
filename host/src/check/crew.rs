//! Pieces of work on several threads, with one result whatever their number.

use std::{
    sync::{
        Mutex, PoisonError,
        atomic::{AtomicUsize, Ordering},
    },
    thread,
};

use super::ledger::Ledger;

/// Does every piece, and merges what they found in their order.
pub(super) fn work<T: Sync>(pieces: &[T], threads: usize, piece: impl Fn(&T) -> Ledger + Sync) -> Ledger {
    let mut all = Ledger::default();
    each(pieces, threads, piece).into_iter().for_each(|found| all.merge(found));
    all
}

/// Does every piece, and gives what they found in their order.
pub(super) fn each<T: Sync, R: Send>(pieces: &[T], threads: usize, piece: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let (next, done) = (AtomicUsize::new(0), Mutex::new(Vec::with_capacity(pieces.len())));
    let hand = || {
        while let at = next.fetch_add(1, Ordering::Relaxed)
            && let Some(one) = pieces.get(at)
        {
            let found = piece(one);
            done.lock().unwrap_or_else(PoisonError::into_inner).push((at, found));
        }
    };
    thread::scope(|scope| {
        for _ in 1..threads.clamp(1, pieces.len().max(1)) {
            scope.spawn(hand);
        }
        hand();
    });
    let mut done = done.into_inner().unwrap_or_else(PoisonError::into_inner);
    done.sort_by_key(|(at, _)| *at);
    done.into_iter().map(|(_, found)| found).collect()
}
