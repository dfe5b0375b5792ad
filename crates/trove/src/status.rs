//! `trove status`: how far a folder is that runs, or parts of one on other machines, are writing to.

use std::collections::HashSet;
use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};
use std::path::Path;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use anyhow::{Context, Result, ensure};
use serde::Serialize;
use trove_format::{FrameLine, JournalLine, Manifest, PlanLine};

use crate::answer::Answer;
use crate::progress::duration;
use crate::run::{PRIVATE, Share, journals, part_folders};
use crate::store;

/// Nothing for so many times as long as a frame takes, and for as long as this, is told of.
const SILENT_FRAMES: f64 = 20.0;
const SILENT_S: f64 = 600.0;

/// How far a folder is.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Status {
    /// Frames of the whole recipe, as far as they are known.
    frames: u64,
    /// Those that are finished.
    finished: u64,
    /// Seconds until all are, at the pace of those that are at work; null where none is.
    seconds_left: Option<f64>,
    /// Whether a run has summed all frames up in the manifest.
    merged: bool,
    /// Parts that have begun.
    parts: Vec<Journalled>,
    /// Parts that have not.
    not_begun: Vec<String>,
}

/// How far a part is, or a run of all frames.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Journalled {
    /// `I/N`; null of a run of all frames.
    part: Option<String>,
    /// Frames that it makes, as far as they are known.
    frames: u64,
    /// Those that are finished.
    finished: u64,
    /// Seconds since it last wrote something down.
    silent_s: f64,
    /// Seconds a frame since it was last started; null before the first.
    frame_s: Option<f64>,
    /// Seconds until it has ended at that pace, 0 where it has; null where that is not known, or it has been silent for so
    /// long that it seems to have stopped.
    seconds_left: Option<f64>,
}

/// Reads the journals and nothing else: no lock is taken, and nothing is changed.
///
/// # Errors
/// A folder that no run has written, or whose journals cannot be read.
pub(crate) fn run(folder: &Path, as_json: bool) -> Result<Answer> {
    let status = match store::address(folder) {
        None => look(folder, SystemTime::now())?,
        Some(address) => look(&journals(address)?.0, SystemTime::now()).with_context(|| address.to_owned())?,
    };
    let json = serde_json::to_value(&status)?;
    Ok(Answer::new(as_json, json, move || tell(&status)))
}

fn look(folder: &Path, now: SystemTime) -> Result<Status> {
    let private = folder.join(PRIVATE);
    ensure!(
        private.is_dir(),
        "{}: expected an output folder of trove generate, found no {PRIVATE} in it",
        folder.display()
    );
    let mut frames = HashSet::new();
    let (whole, whole_plan) = journal(&private, None, now, &mut frames)?;
    let mut plans = vec![whole_plan];
    let mut parts = Vec::new();
    for (share, part) in part_folders(folder)? {
        let (part, plan) = journal(&part, Some(share), now, &mut frames)?;
        parts.push((share, part));
        plans.push(plan);
    }
    let finished = frames.len() as u64;
    let merged = parts.is_empty() && whole.is_done() && folder.join(Manifest::NAME).is_file();
    // Of several divisions of one recipe the finest is taken for the one in use.
    let of = parts.iter().map(|(share, _)| share.of()).max().unwrap_or(0);
    let begun = |share: &Share| parts.iter().any(|(part, _)| part == share);
    let not_begun: Vec<String> = Share::all(of).filter(|share| !begun(share)).map(|share| share.to_string()).collect();
    let told = plans.into_iter().flatten().max_by_key(|plan| plan.started_unix_s).map_or(0, |plan| plan.of);
    let mut parts: Vec<Journalled> = parts.into_iter().map(|(_, part)| part).collect();
    if parts.is_empty() {
        parts.push(whole);
    }
    let frames = if merged { finished } else { told.max(finished) };
    let is_at_work = |part: &&Journalled| part.seconds_left.is_some_and(|left| left > 0.0);
    let pace_hz: f64 = parts.iter().filter(is_at_work).filter_map(|part| Some(1.0 / part.frame_s?)).sum();
    // Not before the last of those at work, and not before as many as these have made the rest.
    let slowest_s = parts.iter().filter_map(|part| part.seconds_left).fold(0.0, f64::max);
    let seconds_left = match frames - finished {
        0 => Some(0.0),
        _ if pace_hz == 0.0 => None,
        left => Some(slowest_s.max(left as f64 / pace_hz)),
    };
    Ok(Status { frames, finished, seconds_left, merged, parts, not_begun })
}

/// What a journal says; its finished frames are added to `all`.
fn journal(
    folder: &Path,
    share: Option<Share>,
    now: SystemTime,
    all: &mut HashSet<u64>,
) -> Result<(Journalled, Option<PlanLine>)> {
    let path = folder.join(FrameLine::JOURNAL);
    let (mut own, mut since, mut plan) = (HashSet::new(), 0_u64, None::<PlanLine>);
    FrameLine::each(&path, |line, _| match line {
        JournalLine::Frame(line) => {
            let mut hasher = DefaultHasher::new();
            line.frame.hash(&mut hasher);
            own.insert(hasher.finish());
            since += 1;
        }
        JournalLine::Plan(next) => {
            if plan.is_none_or(|plan| plan.started_unix_s != next.started_unix_s) {
                since = 0;
            }
            plan = Some(next);
        }
    })?;
    let finished = own.len() as u64;
    all.extend(own);
    let frames = plan.map_or(finished, |plan| plan.planned.max(finished));
    let written = std::fs::metadata(&path).and_then(|found| found.modified()).unwrap_or(now);
    let silent_s = now.duration_since(written).unwrap_or_default().as_secs_f64();
    let frame_s = plan.filter(|_| since > 0).map(|plan| {
        let started = UNIX_EPOCH + Duration::from_secs(plan.started_unix_s);
        written.duration_since(started).unwrap_or_default().as_secs_f64().max(1e-3) / since as f64
    });
    let seconds_left = match frames - finished {
        0 => Some(0.0),
        left => frame_s.filter(|s| silent_s < SILENT_S.max(SILENT_FRAMES * s)).map(|s| s * left as f64),
    };
    let part = share.map(|share| share.to_string());
    Ok((Journalled { part, frames, finished, silent_s, frame_s, seconds_left }, plan))
}

impl Journalled {
    fn is_done(&self) -> bool {
        self.finished >= self.frames
    }
}

fn tell(status: &Status) {
    let Status { frames, finished, seconds_left, merged, parts, not_begun } = status;
    let left = match seconds_left {
        _ if *merged => "merged".into(),
        Some(left) if *left > 0.0 => format!("about {} left", duration(*left)),
        Some(_) => "to be merged: trove generate without --part".into(),
        None => "nobody is at work".into(),
    };
    println!("{finished} of {frames} frames, {left}");
    for Journalled { part, frames, finished, silent_s, seconds_left, .. } in parts {
        let Some(part) = part else { continue };
        let state = match seconds_left {
            Some(left) if *left > 0.0 => format!("about {} left", duration(*left)),
            Some(_) => "done".into(),
            None if *finished == 0 && *silent_s < SILENT_S => "begun".into(),
            None => format!("silent for {}: if it has stopped, run it again", duration(*silent_s)),
        };
        println!("part {part}: {finished} of {frames}, {state}");
    }
    if !not_begun.is_empty() {
        println!("not begun: {}", not_begun.join(", "));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trove_format::WrittenFile;

    fn frames(numbers: std::ops::Range<u32>) -> Vec<JournalLine> {
        let file = WrittenFile { name: "class.png".into(), sha256: "00".into(), bytes: 1 };
        let line =
            |k| JournalLine::Frame(FrameLine { frame: format!("s/v00/k{k:03}/ego.A"), files: vec![file.clone()] });
        numbers.map(line).collect()
    }

    /// Writes a journal whose last line is so old.
    fn write(folder: &Path, lines: &[Vec<JournalLine>], age_s: u64, now: SystemTime) {
        std::fs::create_dir_all(folder).unwrap();
        let path = folder.join(FrameLine::JOURNAL);
        std::fs::write(&path, lines.concat().iter().flat_map(JournalLine::to_json).collect::<Vec<_>>()).unwrap();
        let file = std::fs::File::options().write(true).open(&path).unwrap();
        file.set_modified(now - Duration::from_secs(age_s)).unwrap();
    }

    #[test]
    fn journals_tell_who_is_at_work_and_when_it_ends() {
        let dir = tempfile::tempdir().unwrap();
        assert!(look(dir.path(), SystemTime::now()).unwrap_err().to_string().contains("expected an output folder"));
        let private = dir.path().join(PRIVATE);
        let now = UNIX_EPOCH + Duration::from_secs(2_000_000);
        let plan = |planned, started_s: u64| {
            vec![JournalLine::Plan(PlanLine { planned, of: 40, started_unix_s: 2_000_000 - started_s })]
        };
        // Begun, killed and begun again 100 s ago: two frames in 100 s.
        let first = [plan(10, 9_000), frames(0..5), plan(10, 100), frames(5..7), plan(10, 100)];
        write(&private.join("parts/1-of-4"), &first, 0, now);
        write(&private.join("parts/2-of-4"), &[plan(10, 500), frames(10..20)], 300, now);
        write(&private.join("parts/3-of-4"), &[plan(10, 8_100), frames(20..21)], 8_000, now);
        let status = look(dir.path(), now).unwrap();
        assert_eq!((status.frames, status.finished, status.merged), (40, 18, false));
        assert_eq!(status.not_begun, ["4/4"]);
        let left: Vec<_> = status.parts.iter().map(|part| (part.finished, part.seconds_left)).collect();
        assert_eq!(left, [(7, Some(150.0)), (10, Some(0.0)), (1, None)]);
        // The only one at work would have to make all that is left.
        assert_eq!(status.seconds_left, Some(22.0 * 50.0));
        // A run of all has taken them over and gone on.
        std::fs::remove_dir_all(private.join("parts")).unwrap();
        write(&private, &[frames(0..18), plan(40, 60), frames(18..40)], 1, now);
        let status = look(dir.path(), now).unwrap();
        assert_eq!((status.finished, status.seconds_left, status.merged), (40, Some(0.0), false));
        std::fs::write(dir.path().join(Manifest::NAME), "{}").unwrap();
        assert!(look(dir.path(), now).unwrap().merged);
    }
}
