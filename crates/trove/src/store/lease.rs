//! Who is at work on something in a store, where there are no locks.

use std::sync::Arc;
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread::JoinHandle;
use std::time::{Duration, SystemTime};

use anyhow::{Context, Result, bail};

use super::{Object, Store};

/// Whoever has not renewed its claim for so long has ended without giving it back.
const LEASE: Duration = Duration::from_secs(120);
/// How often a claim is renewed.
const RENEWED: Duration = Duration::from_secs(30);

/// A claim on something: an object that is written anew as long as its owner lives, and removed when that ends. Who is
/// cut off for long may lose it to another; both then make the same bytes.
pub(crate) struct Lease {
    store: Arc<Store>,
    name: String,
    end: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Lease {
    /// Claims something that nobody has; `owner` is told to whoever comes next.
    ///
    /// # Errors
    /// A claim of somebody who is at work, or a store that refuses.
    pub(crate) fn take(store: &Arc<Store>, name: &str, owner: &str) -> Result<Self> {
        if !store.create(name, owner.as_bytes().to_vec())? {
            if let Some(other) = fresh(store, name)? {
                bail!("{other}");
            }
            // Of several that find it abandoned, one gets it.
            let taken = match store.look(name)? {
                Some(left) => store.replace(&left, owner.as_bytes().to_vec())?,
                None => store.create(name, owner.as_bytes().to_vec())?,
            };
            if !taken {
                bail!("{}", fresh(store, name)?.context("another worker was quicker")?);
            }
        }
        let (stop, stopped) = mpsc::channel();
        let (renewing, renewed, bytes) = (store.clone(), name.to_owned(), owner.as_bytes().to_vec());
        let renew = std::thread::spawn(move || {
            while stopped.recv_timeout(RENEWED) == Err(RecvTimeoutError::Timeout) {
                if let Err(error) = renewing.put(&renewed, bytes.clone()) {
                    tracing::warn!("{error}");
                }
            }
        });
        Ok(Self { store: store.clone(), name: name.to_owned(), end: Some((stop, renew)) })
    }

    /// Gives it back.
    fn end(&mut self) {
        let Some((stop, renew)) = self.end.take() else { return };
        drop(stop);
        // It has nothing to tell; a claim that stays runs out.
        let _ = renew.join();
        if let Err(error) = self.store.remove(&self.name) {
            tracing::warn!("{error}");
        }
    }
}

impl Drop for Lease {
    fn drop(&mut self) {
        self.end();
    }
}

/// Who is at work on something, if anybody is.
pub(crate) fn fresh(store: &Store, name: &str) -> Result<Option<String>> {
    let Some(Object { modified, .. }) = store.look(name)? else { return Ok(None) };
    let ago = SystemTime::now().duration_since(modified).unwrap_or_default();
    if ago > LEASE {
        return Ok(None);
    }
    let owner = store.get(name)?.unwrap_or_default();
    let (owner, left) = (String::from_utf8_lossy(&owner).into_owned(), (LEASE - ago).as_secs());
    Ok(Some(format!(
        "{}: {owner} is at work there; wait for it to end, or, where it was killed, {left} s",
        store.address(name)
    )))
}
