//! A store that can be reached, whose calls wait; what is long goes on beside the caller.

use std::future::Future;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{self, Receiver};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, anyhow};
use futures_util::{StreamExt, TryStreamExt, stream};
use object_store::client::HttpError;
use object_store::path::Path;
use object_store::{
    Error, ObjectMeta, ObjectStore, ObjectStoreExt, PutMode, PutOptions, PutPayload, UpdateVersion, parse_url_opts,
};
use tokio::runtime::{Builder, Runtime};
use trove_files::{LARGEST_FILE, read_regular};
use url::Url;

use super::Object;

/// Objects that are sent or fetched at once.
const AT_ONCE: usize = 8;
/// For so long answers are asked for again that break off on the way. The library repeats requests that are refused or not
/// answered; once it has given up, which takes longer, so do we.
const PATIENCE: Duration = Duration::from_secs(30);
/// The first pause before that; each is twice as long as the last.
const PAUSE: Duration = Duration::from_millis(100);
/// An object of many megabytes takes longer than the library's half minute on a slow line.
const TIMEOUT: (&str, &str) = ("timeout", "5 minutes");
/// What these variables say of credentials, regions and endpoints is told to the store; docs/cluster.md names them.
const VARIABLES: [&str; 3] = ["AWS_", "GOOGLE_", "AZURE_"];

/// A store, below a prefix.
pub(crate) struct Store {
    address: String,
    prefix: Path,
    store: Arc<dyn ObjectStore>,
    runtime: Runtime,
}

/// What comes of something that goes on beside the caller.
pub(crate) struct Answer {
    told: Option<Result<()>>,
    waiting: Receiver<Result<()>>,
}

impl Answer {
    /// Whether it has ended.
    pub(crate) fn is_there(&mut self) -> bool {
        self.told = self.told.take().or_else(|| self.waiting.try_recv().ok());
        self.told.is_some()
    }

    /// Waits until it has.
    pub(crate) fn wait(self) -> Result<()> {
        self.told.unwrap_or_else(|| self.waiting.recv().context("the store's thread has ended")?)
    }
}

impl Store {
    /// Opens a store; nothing is asked of it yet.
    ///
    /// # Errors
    /// An address that is none of a store, or credentials that cannot be read.
    pub(crate) fn open(address: &str) -> Result<Self> {
        let expected = || format!("{address}: expected the address of an object store such as s3://bucket/prefix");
        let url = Url::parse(address).with_context(expected)?;
        let variables = std::env::vars_os().filter_map(|(name, value)| Some((name.into_string().ok()?, value)));
        let told = variables.filter(|(name, _)| VARIABLES.iter().any(|start| name.starts_with(start)));
        let told = told.filter_map(|(name, value)| Some((name, value.into_string().ok()?)));
        let options = [(TIMEOUT.0.to_owned(), TIMEOUT.1.to_owned())].into_iter().chain(told);
        // Another provider may have been installed before; any will do.
        let _ = rustls::crypto::ring::default_provider().install_default();
        let (store, prefix) = parse_url_opts(&url, options).with_context(expected)?;
        Self::of(address, store.into(), prefix)
    }

    fn of(address: &str, store: Arc<dyn ObjectStore>, prefix: Path) -> Result<Self> {
        let runtime = Builder::new_multi_thread().worker_threads(2).enable_all().build()?;
        Ok(Self { address: address.to_owned(), prefix, store, runtime })
    }

    /// The address of an object.
    pub(crate) fn address(&self, name: &str) -> String {
        format!("{}/{name}", self.address)
    }

    fn at(&self, name: &str) -> Result<Path> {
        let prefix = self.prefix.as_ref();
        let slash = if prefix.is_empty() || name.is_empty() { "" } else { "/" };
        Path::parse(format!("{prefix}{slash}{name}")).with_context(|| self.address(name))
    }

    /// Writes an object, whether it is there or not.
    pub(crate) fn put(&self, name: &str, bytes: Vec<u8>) -> Result<()> {
        self.write(name, bytes, PutMode::Overwrite).map(drop)
    }

    /// Writes an object that is not there yet; false where somebody else was first.
    pub(crate) fn create(&self, name: &str, bytes: Vec<u8>) -> Result<bool> {
        // Where the answer was lost on the way, the object is there when it is asked for again.
        Ok(self.write(name, bytes.clone(), PutMode::Create)? || self.get(name)?.is_some_and(|found| found == bytes))
    }

    /// Writes an object that nobody has written since it was looked at; false where somebody has.
    pub(crate) fn replace(&self, object: &Object, bytes: Vec<u8>) -> Result<bool> {
        let version = UpdateVersion { e_tag: object.version.clone(), version: None };
        let name = &object.name;
        Ok(self.write(name, bytes.clone(), PutMode::Update(version))?
            || self.get(name)?.is_some_and(|found| found == bytes))
    }

    fn write(&self, name: &str, bytes: Vec<u8>, mode: PutMode) -> Result<bool> {
        let at = self.at(name)?;
        let (options, bytes) = (PutOptions { mode, ..PutOptions::default() }, PutPayload::from(bytes));
        let put = whole(|| self.store.put_opts(&at, bytes.clone(), options.clone()));
        match self.runtime.block_on(put) {
            Ok(_) => Ok(true),
            Err(Error::AlreadyExists { .. } | Error::Precondition { .. }) => Ok(false),
            Err(error) => Err(self.refused("written", name, error)),
        }
    }

    /// Reads an object; `None` where it is not there.
    pub(crate) fn get(&self, name: &str) -> Result<Option<Vec<u8>>> {
        let at = self.at(name)?;
        match self.runtime.block_on(read(&*self.store, &at)) {
            Ok(bytes) => Ok(Some(bytes)),
            Err(Error::NotFound { .. }) => Ok(None),
            Err(error) => Err(self.refused("read", name, error)),
        }
    }

    /// What is known of an object; `None` where it is not there.
    pub(crate) fn look(&self, name: &str) -> Result<Option<Object>> {
        let at = self.at(name)?;
        if at.as_ref().is_empty() {
            return Ok(None); // the bucket itself
        }
        match self.runtime.block_on(whole(|| self.store.head(&at))) {
            Ok(found) => Ok(Some(self.object(name.to_owned(), &found))),
            Err(Error::NotFound { .. }) => Ok(None),
            Err(error) => Err(self.refused("read", name, error)),
        }
    }

    /// The objects whose names begin with those folders, in alphabetical order.
    pub(crate) fn list(&self, folder: &str) -> Result<Vec<Object>> {
        let at = self.at(folder)?;
        let listed: Vec<ObjectMeta> = self
            .runtime
            .block_on(whole(|| self.store.list(Some(&at)).try_collect()))
            .map_err(|error| self.refused("listed", folder, error))?;
        let below = |found: &ObjectMeta| {
            let parts = found.location.prefix_match(&self.prefix)?;
            Some(parts.map(|part| part.as_ref().to_owned()).collect::<Vec<_>>().join("/"))
        };
        let mut objects: Vec<Object> =
            listed.iter().filter_map(|found| Some(self.object(below(found)?, found))).collect();
        objects.sort_by(|a, b| a.name.cmp(&b.name));
        Ok(objects)
    }

    fn object(&self, name: String, found: &ObjectMeta) -> Object {
        let version = found.e_tag.clone().or_else(|| found.version.clone());
        Object { name, bytes: found.size, version, modified: found.last_modified.into() }
    }

    /// Removes an object, which may be gone already.
    pub(crate) fn remove(&self, name: &str) -> Result<()> {
        let at = self.at(name)?;
        match self.runtime.block_on(whole(|| self.store.delete(&at))) {
            Ok(()) | Err(Error::NotFound { .. }) => Ok(()),
            Err(error) => Err(self.refused("removed", name, error)),
        }
    }

    /// Sends files as objects, several at once, and the last of them after all others, while the caller goes on.
    pub(crate) fn send(&self, mut files: Vec<(String, PathBuf)>) -> Answer {
        let last = files.split_off(files.len().saturating_sub(1));
        let one = |store: Arc<dyn ObjectStore>, at: Path, file: PathBuf| async move {
            // Just written, so it comes from memory.
            let bytes = read_regular(&file, LARGEST_FILE).with_context(|| file.display().to_string())?;
            let bytes = PutPayload::from(bytes);
            Ok(whole(|| store.put(&at, bytes.clone())).await.map(drop)?)
        };
        self.beside([files, last].into(), "written", one)
    }

    /// Fetches objects as files, several at once, while the caller goes on; a file is whole or not there.
    pub(crate) fn fetch(&self, files: Vec<(String, PathBuf)>) -> Answer {
        let one = |store: Arc<dyn ObjectStore>, at: Path, file: PathBuf| async move {
            let bytes = read(&*store, &at).await?;
            let folder = file.parent().unwrap_or(&file);
            std::fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
            trove_files::write_atomically(&file, &bytes).with_context(|| file.display().to_string())
        };
        self.beside([files].into(), "read", one)
    }

    /// Does the same with groups of objects and files, one group after another.
    fn beside<F: Future<Output = Result<()>> + Send + 'static>(
        &self,
        groups: Vec<Vec<(String, PathBuf)>>,
        done: &'static str,
        one: impl Fn(Arc<dyn ObjectStore>, Path, PathBuf) -> F + Send + Sync + 'static,
    ) -> Answer {
        let (tell, waiting) = mpsc::channel();
        let placed = |(name, file): (String, PathBuf)| Ok((self.address(&name), self.at(&name)?, file));
        let groups: Result<Vec<Vec<_>>> =
            groups.into_iter().map(|group| group.into_iter().map(placed).collect()).collect();
        let store = self.store.clone();
        self.runtime.spawn(async move {
            let all = async {
                for group in groups? {
                    let each = group.into_iter().map(|(address, at, file)| {
                        let made = one(store.clone(), at, file);
                        async move { made.await.map_err(|error| refused(done, &address, &error)) }
                    });
                    stream::iter(each).buffer_unordered(AT_ONCE).try_collect::<()>().await?;
                }
                Ok(())
            };
            // Nobody waits any more once a run has failed.
            drop(tell.send(all.await));
        });
        Answer { told: None, waiting }
    }

    fn refused(&self, done: &str, name: &str, error: Error) -> anyhow::Error {
        refused(done, &self.address(name), &error.into())
    }
}

fn refused(done: &str, address: &str, error: &anyhow::Error) -> anyhow::Error {
    anyhow!(
        "{address}: cannot be {done}: {error:#}; check credentials, region and network, then run the same command again"
    )
}

/// An object's bytes.
async fn read(store: &dyn ObjectStore, at: &Path) -> object_store::Result<Vec<u8>> {
    whole(|| async { Ok(store.get(at).await?.bytes().await?.into()) }).await
}

/// An answer, asked for again where it breaks off on the way.
async fn whole<T, F: Future<Output = object_store::Result<T>>>(ask: impl Fn() -> F) -> object_store::Result<T> {
    let (started, mut pause) = (Instant::now(), PAUSE);
    loop {
        match ask().await {
            Err(error) if broke_off(&error) && started.elapsed() < PATIENCE => tokio::time::sleep(pause).await,
            answer => return answer,
        }
        pause *= 2;
    }
}

/// Whether an error is one of the connection, and not what a server has answered.
fn broke_off(error: &Error) -> bool {
    let causes = std::iter::successors(Some(error as &dyn std::error::Error), |error| error.source());
    causes.into_iter().any(|cause| cause.is::<HttpError>())
}

#[cfg(test)]
mod tests {
    use object_store::memory::InMemory;

    use super::*;

    fn store() -> Store {
        Store::of("mem://b/p", Arc::new(InMemory::new()), Path::parse("p").unwrap()).unwrap()
    }

    #[test]
    fn an_object_is_created_once_and_replaced_by_who_knows_it() {
        let store = store();
        assert!(store.create("a/lock", b"1".to_vec()).unwrap());
        assert!(!store.create("a/lock", b"2".to_vec()).unwrap());
        assert!(store.create("a/lock", b"1".to_vec()).unwrap(), "one's own, whose answer was lost");
        let known = store.look("a/lock").unwrap().unwrap();
        assert!(store.replace(&known, b"3".to_vec()).unwrap());
        assert!(!store.replace(&known, b"4".to_vec()).unwrap());
        assert_eq!(store.get("a/lock").unwrap().unwrap(), b"3");
        store.remove("a/lock").unwrap();
        store.remove("a/lock").unwrap();
        assert_eq!(store.get("a/lock").unwrap(), None);
        assert!(store.look("a/lock").unwrap().is_none());
    }

    #[test]
    fn files_are_sent_and_fetched_and_listed_by_their_names() {
        let (store, dir) = (store(), tempfile::tempdir().unwrap());
        let file = dir.path().join("file");
        std::fs::write(&file, "abc").unwrap();
        store.send(vec![("s/v00/b".into(), file.clone()), ("s/v00/a".into(), file.clone())]).wait().unwrap();
        store.put("s/v001", Vec::new()).unwrap();
        let listed: Vec<_> = store.list("s/v00").unwrap().into_iter().map(|o| (o.name, o.bytes)).collect();
        assert_eq!(listed, [("s/v00/a".to_owned(), 3), ("s/v00/b".to_owned(), 3)]);
        assert_eq!(store.list("").unwrap().len(), 3);
        let to = dir.path().join("new/file");
        store.fetch(vec![("s/v00/a".into(), to.clone())]).wait().unwrap();
        assert_eq!(std::fs::read(to).unwrap(), b"abc");
        let message = store.fetch(vec![("none".into(), file)]).wait().unwrap_err().to_string();
        assert!(
            message.starts_with("mem://b/p/none: cannot be read") && message.contains("check credentials"),
            "{message}"
        );
    }
}
