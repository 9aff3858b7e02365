//! Sorting numbers that are all different, without memory of their own.

#[cfg(test)]
mod tests;

/// Up to a number in this many, comparing them is quicker than going through a bit for each that there could be.
const SPARSE: usize = 256;

/// Sorts the numbers from `start` on. They must all be different and below `end`.
///
/// Many are sorted by setting a bit for each, in words behind the list, and reading the bits back in order.
pub(crate) fn sort(numbers: &mut Vec<u32>, start: usize, end: usize) {
    let count = numbers.len() - start;
    if count <= end / SPARSE {
        return numbers[start..].sort_unstable();
    }
    numbers.resize(numbers.len() + end.div_ceil(32), 0);
    let (numbers_in, words) = numbers[start..].split_at_mut(count);
    for &number in &*numbers_in {
        words[number as usize / 32] |= 1 << (number % 32);
    }
    let mut sorted = numbers_in.iter_mut();
    for (first, word) in (0u32..).step_by(32).zip(words) {
        while *word != 0
            && let Some(slot) = sorted.next()
        {
            *slot = first + word.trailing_zeros();
            *word &= *word - 1;
        }
    }
    numbers.truncate(start + count);
}
