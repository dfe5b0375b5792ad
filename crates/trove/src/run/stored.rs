//! An output folder in an object store. The run works in a folder of the cache, where only what is under way lies, and
//! every finished frame is sent from there, its table last.

use std::collections::{BTreeMap, VecDeque};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, anyhow, bail, ensure};
use trove_files::{FolderLock, LARGEST_FILE, LARGEST_TEXT, read_regular, read_text, write_atomically};
use trove_format::{
    FrameLine, FrameTable, GridTable, LanesFile, Manifest, RadarTable, RunIdentity, SiteFile, SweepTable,
    TrajectoryFile, WrittenFile,
};
use trove_write::{FrameFolders, sha256, sha256_file};

use super::private::{PARTS, PRIVATE, now_ns};
use super::share::Share;
use crate::cache;
use crate::store::{Answer, Lease, Object, Store, fresh};

/// Frames that are sent while further ones are rendered; their files wait on the disk.
const SENDING: usize = 16;
/// How often the journal is sent: what it does not tell of after a power cut is read again.
const JOURNAL_EVERY: Duration = Duration::from_secs(30);
/// What tells that a frame, or what lies beside frames, is whole.
const TABLES: [&str; 4] = [FrameTable::NAME, SweepTable::NAME, RadarTable::NAME, GridTable::NAME];
/// The claim of a worker, beside its journal.
const LOCK: &str = "lock";

/// Names and lengths of files, by the paths of their frames.
type Lying = BTreeMap<String, BTreeMap<String, u64>>;

/// The store's side of an output folder.
pub(super) struct StoredFolder {
    store: Arc<Store>,
    /// Where the run works.
    working: PathBuf,
    /// The folder of this worker's journal and claim, below the output folder.
    private: String,
    /// The frames that lie there of the variation that was asked for last.
    listed: Option<(String, Lying)>,
    sending: VecDeque<(FrameLine, Answer)>,
    journal_sent: Instant,
    _lease: Lease,
    _lock: FolderLock,
}

impl StoredFolder {
    /// Claims a part, or the whole, and brings what a run goes on from.
    pub(super) fn open(address: &str, share: Option<Share>) -> Result<Self> {
        let store = Arc::new(Store::open(address)?);
        let private = match share {
            None => PRIVATE.to_owned(),
            Some(share) => format!("{PRIVATE}/{PARTS}/{}", share.folder()),
        };
        let claim = format!("{private}/{LOCK}");
        let (claims, begun): (Vec<Object>, Vec<Object>) =
            store.list(PRIVATE)?.into_iter().partition(|object| is_claim(&object.name));
        let run = format!("{PRIVATE}/{}", RunIdentity::NAME);
        let is_ours = begun.iter().any(|object| object.name == run);
        ensure!(
            is_ours || store.list("")?.iter().all(|object| object.name.starts_with(PRIVATE)),
            "{address}: expected nothing below this prefix, or an earlier run, found other objects; choose another --out"
        );
        // Parts keep off a run of all frames, and that keeps off parts.
        let whole = format!("{PRIVATE}/{LOCK}");
        for other in claims.iter().filter(|other| other.name != claim && (share.is_none() || other.name == whole)) {
            if let Some(who) = fresh(&store, &other.name)? {
                bail!("{who}");
            }
        }
        let owner = format!("process {} of the machine {}, begun at {}", std::process::id(), host(), now_ns());
        let lease = Lease::take(&store, &claim, &owner)?;
        let (working, lock) = working_folder(address, &private)?;
        bring(&store, &begun, &working)?;
        Ok(Self {
            store,
            working,
            private,
            listed: None,
            sending: VecDeque::new(),
            journal_sent: Instant::now(),
            _lease: lease,
            _lock: lock,
        })
    }

    /// Where the run works.
    pub(super) fn working(&self) -> &Path {
        &self.working
    }

    /// Makes what this run is made of known to others; false where another part was first, whose file lies in the working
    /// folder now.
    pub(super) fn share_identity(&self) -> Result<bool> {
        let name = format!("{PRIVATE}/{}", RunIdentity::NAME);
        let path = self.working.join(&name);
        let own = read_regular(&path, LARGEST_FILE).with_context(|| path.display().to_string())?;
        if self.store.create(&name, own.clone())? {
            return Ok(true);
        }
        let theirs =
            self.store.get(&name)?.with_context(|| format!("{}: removed meanwhile", self.store.address(&name)))?;
        let is_new = theirs != own;
        write_atomically(&path, &theirs).with_context(|| path.display().to_string())?;
        Ok(!is_new)
    }

    /// Sends the identity of a run that goes on with more frames.
    pub(super) fn send_identity(&self) -> Result<()> {
        let name = format!("{PRIVATE}/{}", RunIdentity::NAME);
        self.store.send(vec![(name.clone(), self.working.join(name))]).wait()
    }

    /// Brings what an earlier run has built of a variation of a scene.
    pub(super) fn bring_site(&self, folder: &str) -> Result<()> {
        if self.working.join(folder).join(SiteFile::NAME).is_file() {
            return Ok(());
        }
        if self.store.look(&format!("{folder}/{}", SiteFile::NAME))?.is_some() {
            self.store.fetch(self.site_files(folder)).wait()?;
        }
        Ok(())
    }

    /// Sends what was built of a variation of a scene, the site last.
    pub(super) fn send_site(&self, folder: &str) -> Result<()> {
        self.store.send(self.site_files(folder)).wait()
    }

    fn site_files(&self, folder: &str) -> Vec<(String, PathBuf)> {
        let names = [TrajectoryFile::NAME, LanesFile::NAME, SiteFile::NAME];
        names.map(|name| (format!("{folder}/{name}"), self.working.join(folder).join(name))).to_vec()
    }

    /// The files of a frame that lies in the store, whole; `told` is what a journal says of it.
    pub(super) fn finished(
        &mut self,
        frame: &str,
        expected: &[&str],
        told: Option<Vec<WrittenFile>>,
    ) -> Result<Option<Vec<WrittenFile>>> {
        let lying = self.lying(frame)?;
        if !expected.iter().all(|name| lying.contains_key(*name)) {
            return Ok(None);
        }
        if let Some(files) = told {
            let is_whole = files.iter().all(|file| lying.get(&file.name) == Some(&file.bytes));
            let has_all = expected.iter().all(|name| files.iter().any(|file| file.name == *name));
            if is_whole && has_all {
                return Ok(Some(files));
            }
        }
        // It was sent, but the worker ended before its journal was.
        let folder = self.working.join(frame);
        let names = || expected.iter().map(|name| ((*name).to_owned(), folder.join(name)));
        self.store.fetch(names().map(|(name, path)| (format!("{frame}/{name}"), path)).collect()).wait()?;
        let written = |(name, path): (String, PathBuf)| -> Result<WrittenFile> {
            Ok(WrittenFile { sha256: sha256_file(&path)?, bytes: lying[&name], name })
        };
        let mut files: Vec<WrittenFile> = names().map(written).collect::<Result<_>>()?;
        files.sort_by(|a, b| a.name.cmp(&b.name));
        std::fs::remove_dir_all(&folder).with_context(|| folder.display().to_string())?;
        Ok(Some(files))
    }

    /// Names and lengths of what lies of a frame.
    fn lying(&mut self, frame: &str) -> Result<BTreeMap<String, u64>> {
        let variation: String = frame.splitn(3, '/').take(2).collect::<Vec<_>>().join("/");
        if self.listed.as_ref().is_none_or(|(listed, _)| *listed != variation) {
            let mut frames = Lying::new();
            for object in self.store.list(&variation)? {
                if let Some((frame, name)) = object.name.rsplit_once('/') {
                    frames.entry(frame.to_owned()).or_default().insert(name.to_owned(), object.bytes);
                }
            }
            self.listed = Some((variation, frames));
        }
        Ok(self.listed.as_ref().and_then(|(_, frames)| frames.get(frame)).cloned().unwrap_or_default())
    }

    /// Sends a frame that lies in the working folder, its table last, while the run goes on; gives back those that have
    /// arrived, to be written down.
    pub(super) fn send(&mut self, line: FrameLine) -> Result<Vec<FrameLine>> {
        let is_table = |file: &&WrittenFile| TABLES.contains(&file.name.as_str());
        let (tables, rest): (Vec<_>, Vec<_>) = line.files.iter().partition(is_table);
        let object = |file: &WrittenFile| {
            let name = format!("{}/{}", line.frame, file.name);
            let path = self.working.join(&name);
            (name, path)
        };
        let files = rest.into_iter().chain(tables).map(object).collect();
        let answer = self.store.send(files);
        self.sending.push_back((line, answer));
        self.arrived(SENDING)
    }

    /// Waits until no more than so many frames are being sent, and gives back those that have arrived.
    pub(super) fn arrived(&mut self, under_way: usize) -> Result<Vec<FrameLine>> {
        let mut arrived = Vec::new();
        while let Some((_, answer)) = self.sending.front_mut() {
            if !answer.is_there() && self.sending.len() <= under_way {
                break;
            }
            let Some((line, answer)) = self.sending.pop_front() else { break };
            answer.wait()?;
            let folder = self.working.join(&line.frame);
            std::fs::remove_dir_all(&folder).with_context(|| folder.display().to_string())?;
            if let Some((variation, frames)) = &mut self.listed
                && line.frame.starts_with(&format!("{variation}/"))
            {
                let files = line.files.iter().map(|file| (file.name.clone(), file.bytes));
                frames.insert(line.frame.clone(), files.collect());
            }
            arrived.push(line);
        }
        Ok(arrived)
    }

    /// Sends the journal, where that is due.
    pub(super) fn journal(&mut self, is_due: bool) -> Result<()> {
        if is_due || self.journal_sent.elapsed() > JOURNAL_EVERY {
            let name = format!("{}/{}", self.private, FrameLine::JOURNAL);
            self.store.send(vec![(name.clone(), self.working.join(name))]).wait()?;
            self.journal_sent = Instant::now();
        }
        Ok(())
    }

    /// Brings files into the working folder.
    pub(super) fn bring(&self, files: Vec<String>) -> Result<()> {
        let placed = |name: String| {
            let path = self.working.join(&name);
            (name, path)
        };
        self.store.fetch(files.into_iter().map(placed).collect()).wait()
    }

    /// Sends what sums a run up, the manifest last, and takes the parts' journals away, whose lines its own has now.
    pub(super) fn finish(&mut self) -> Result<()> {
        self.journal(true)?;
        let sums = FrameFolders::RESERVED.into_iter().filter(|name| *name != FrameFolders::EXPORTS);
        let (manifest, rest): (Vec<&str>, Vec<&str>) = sums.partition(|name| *name == Manifest::NAME);
        let files = rest.into_iter().chain(manifest).map(|name| (name.to_owned(), self.working.join(name)));
        self.store.send(files.collect()).wait()?;
        for object in self.store.list(&format!("{PRIVATE}/{PARTS}"))? {
            self.store.remove(&object.name)?;
        }
        Ok(())
    }
}

impl Drop for StoredFolder {
    fn drop(&mut self) {
        // It is of no use to anybody; whoever drops it unfinished already has an error to tell of.
        let _ = std::fs::remove_dir_all(&self.working);
    }
}

/// The machine's name, as far as the system tells it.
fn host() -> String {
    let told = std::env::var("HOSTNAME").ok();
    told.or_else(|| read_text(Path::new("/etc/hostname"), LARGEST_TEXT).ok())
        .map_or("?".into(), |name| name.trim().into())
}

fn is_claim(name: &str) -> bool {
    name.rsplit('/').next() == Some(LOCK)
}

/// An empty folder of the cache for this worker alone.
fn working_folder(address: &str, private: &str) -> Result<(PathBuf, FolderLock)> {
    let cache = cache::folder().context("expected a folder to work in, found none; set TROVE_CACHE")?.join("stored");
    let name = sha256(format!("{address}/{private}").as_bytes());
    let folder = cache.join(&name[..16]);
    std::fs::create_dir_all(&folder).with_context(|| folder.display().to_string())?;
    let path = cache.join(format!("{}.lock", &name[..16]));
    let lock = FolderLock::take(&path).map_err(|error| match error.kind() {
        ErrorKind::WouldBlock => {
            anyhow!("{address}: another process of this machine is at work there; wait for it to end")
        }
        _ => anyhow!("{}: expected a file that can be written: {error}", path.display()),
    })?;
    // What a worker that was killed has left.
    std::fs::remove_dir_all(&folder).with_context(|| folder.display().to_string())?;
    std::fs::create_dir_all(&folder).with_context(|| folder.display().to_string())?;
    Ok((folder, lock))
}

/// Brings objects into a folder, as old as they are in the store. What no worker has named is left.
fn bring(store: &Store, objects: &[Object], folder: &Path) -> Result<()> {
    let below = |object: &Object| -> Option<PathBuf> {
        let parts: Vec<&str> = object.name.split('/').collect();
        let is_plain = |part: &&str| !matches!(*part, "" | "." | "..") && !part.contains(['\\', ':']);
        parts.iter().all(is_plain).then(|| parts.iter().fold(folder.to_owned(), |path, part| path.join(part)))
    };
    let files: Vec<(&Object, PathBuf)> = objects.iter().filter_map(|object| Some((object, below(object)?))).collect();
    store.fetch(files.iter().map(|(object, path)| (object.name.clone(), path.clone())).collect()).wait()?;
    for (object, path) in files {
        let file = std::fs::File::options().write(true).open(&path);
        file.and_then(|file| file.set_modified(object.modified)).with_context(|| path.display().to_string())?;
    }
    Ok(())
}

/// The journals of an output folder in a store, in a folder on this machine that is gone with what is given back.
pub(crate) fn journals(address: &str) -> Result<Journalled> {
    let store = Store::open(address)?;
    let folder = cache::folder().context("expected a folder to work in, found none; set TROVE_CACHE")?;
    let folder = folder.join("stored").join(format!("status-{}-{}", std::process::id(), now_ns()));
    std::fs::create_dir_all(&folder).with_context(|| folder.display().to_string())?;
    let journals = Journalled(folder);
    let mut objects = store.list(PRIVATE)?;
    objects.extend(store.look(Manifest::NAME)?);
    objects.retain(|object| !is_claim(&object.name));
    bring(&store, &objects, &journals.0)?;
    Ok(journals)
}

/// A folder on this machine, removed once it is dropped.
pub(crate) struct Journalled(pub(crate) PathBuf);

impl Drop for Journalled {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}
