//! How much memory a file may make its reader take.

use std::cell::Cell;

/// What any file may ask for, bytes.
const BASE: u64 = 256 << 20;
/// What it may ask for on top for each byte that it has: room for packed maps, meshes and pictures.
const PER_BYTE: u64 = 64;
/// However large it is.
const MOST: u64 = 6 << 30;

/// What is left of the memory that a file may make its reader take: small files that unpack to gigabytes are damaged, or
/// made to do harm.
#[derive(Debug)]
pub struct Budget {
    whole: u64,
    left: Cell<u64>,
}

/// A file asks for more than its budget.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Exceeded {
    whole: u64,
}

impl Budget {
    /// Of a file of so many bytes.
    pub fn of_file(bytes: u64) -> Self {
        let whole = bytes.saturating_mul(PER_BYTE).saturating_add(BASE).min(MOST);
        Self { whole, left: Cell::new(whole) }
    }

    /// Takes memory for `count` things of `size` bytes each.
    ///
    /// # Errors
    /// More than is left, of which nothing is taken then.
    pub fn take(&self, count: usize, size: usize) -> Result<(), Exceeded> {
        let wanted = (count as u64).checked_mul(size as u64);
        let left = wanted.and_then(|wanted| self.left.get().checked_sub(wanted));
        self.left.set(left.ok_or(Exceeded { whole: self.whole })?);
        Ok(())
    }

    /// Bytes that may still be taken.
    pub fn left(&self) -> u64 {
        self.left.get()
    }
}

impl Exceeded {
    /// What is expected instead.
    pub fn expected(self) -> String {
        format!("content that unpacks to at most {} MiB, which is ample for a file of its size", self.whole >> 20)
    }

    /// What is there.
    pub fn found(self) -> String {
        format!("content that unpacks to more than {} MiB", self.whole >> 20)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_budget_grows_with_the_file_and_is_spent_once() {
        let budget = Budget::of_file(1 << 20);
        assert_eq!(budget.left(), (256 + 64) << 20);
        assert!(
            budget.take(300, 1 << 20).is_ok() && budget.take(21, 1 << 20).is_err() && budget.take(20, 1 << 20).is_ok()
        );
        assert!(budget.take(usize::MAX, usize::MAX).is_err());
        assert_eq!(Budget::of_file(u64::MAX).left(), MOST);
    }
}
