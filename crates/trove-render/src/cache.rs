//! What was made of meshes and textures before, for the next scene that shares them.

use std::collections::BTreeMap;
use std::convert::Infallible;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};

use rayon::prelude::*;

/// What was made (`T`) of things (`S`) that somebody else still holds.
pub(crate) struct Cache<S, T> {
    /// By address, which cannot be used again as long as the weak reference is there.
    entries: Mutex<BTreeMap<usize, Entry<S, T>>>,
}

struct Entry<S, T> {
    source: Weak<S>,
    made: Arc<T>,
}

impl<S, T> Default for Cache<S, T> {
    fn default() -> Self {
        Self { entries: Mutex::default() }
    }
}

impl<S, T> Cache<S, T> {
    /// What was made of `source`, or is made now.
    pub(crate) fn get(&self, source: &Arc<S>, make: impl FnOnce(&S) -> T) -> Arc<T> {
        let Ok(made) = self.try_get(source, |source| Ok::<_, Infallible>(make(source)));
        made
    }

    /// The same where making may fail; failures are not remembered.
    pub(crate) fn try_get<E>(&self, source: &Arc<S>, make: impl FnOnce(&S) -> Result<T, E>) -> Result<Arc<T>, E> {
        let address = Arc::as_ptr(source) as usize;
        if let Some(entry) = self.lock().get(&address) {
            return Ok(entry.made.clone());
        }
        // Not under the lock, so that others can be made at the same time.
        let entry = Entry { source: Arc::downgrade(source), made: Arc::new(make(source)?) };
        Ok(self.lock().entry(address).or_insert(entry).made.clone())
    }

    /// Makes all that is missing, with the current thread pool, and forgets what is not used any more.
    pub(crate) fn make_all<'a>(&self, sources: impl Iterator<Item = &'a Arc<S>>, make: impl Fn(&S) -> T + Sync)
    where
        S: Send + Sync + 'a,
        T: Send + Sync,
    {
        self.forget_unused();
        let once: BTreeMap<usize, &Arc<S>> = sources.map(|source| (Arc::as_ptr(source) as usize, source)).collect();
        once.into_par_iter().for_each(|(_, source)| drop(self.get(source, &make)));
    }

    /// Drops what was made of things that are no more.
    pub(crate) fn forget_unused(&self) {
        self.lock().retain(|_, entry| entry.source.strong_count() > 0);
    }

    fn lock(&self) -> MutexGuard<'_, BTreeMap<usize, Entry<S, T>>> {
        self.entries.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thing_is_made_once_as_long_as_it_lives() {
        let cache = Cache::default();
        let source = Arc::new(3);
        let first = cache.get(&source, |n| n + 1);
        assert!(Arc::ptr_eq(&first, &cache.get(&source, |_| panic!("made again"))));
        drop(source);
        cache.forget_unused();
        assert_eq!(cache.lock().len(), 0);
    }
}
