//! Maps pixels in parallel, on all cores.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// Returns the result of `pixel` for each pixel of an image, row by row from the top.
pub(super) fn map_pixels<T: Send>([width, height]: [u32; 2], pixel: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let (width, height) = (width as usize, height as usize);
    let next = AtomicUsize::new(0);
    let work = || {
        let mut done = Vec::new();
        loop {
            let row = next.fetch_add(1, Ordering::Relaxed);
            if row >= height {
                return done;
            }
            done.push((row, (row * width..(row + 1) * width).map(&pixel).collect::<Vec<_>>()));
        }
    };
    let others = thread::available_parallelism().map_or(1, usize::from).min(height).saturating_sub(1);
    let mut all = thread::scope(|scope| {
        let workers: Vec<_> = (0..others).map(|_| scope.spawn(work)).collect();
        let mut all = work();
        for worker in workers {
            all.extend(worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        }
        all
    });
    all.sort_by_key(|(row, _)| *row);
    all.into_iter().flat_map(|(_, row)| row).collect()
}

#[cfg(test)]
mod tests {
    use super::map_pixels;

    #[test]
    fn every_pixel_is_evaluated_once_and_results_are_in_order() {
        assert_eq!(map_pixels([37, 23], |pixel| pixel), (0..37 * 23).collect::<Vec<_>>());
        assert!(map_pixels([5, 0], |pixel| pixel).is_empty());
    }
}
