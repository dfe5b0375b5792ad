//! A film a camera, by the installed ffmpeg.

use std::ffi::OsString;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use trove_files::{LARGEST_FILE, read_regular};
use trove_format::FrameFile;

use super::dataset::Dataset;
use super::plan::Plan;
use super::unit::Unit;
use crate::WriteError;

/// `<split>/<scene>_v<variation>_<view>.mp4`, H.264.
pub(super) struct Video;

/// Frames a second where a sequence has one frame alone.
const ALONE_HZ: f64 = 2.0;

impl Dataset for Video {
    fn units(&self, plan: &Plan) -> Vec<Vec<usize>> {
        plan.sequences()
    }

    fn write(&self, plan: &Plan, frames: &[usize], unit: &mut Unit<'_>) -> Result<(), WriteError> {
        let opened = frames.iter().map(|i| plan.open(&plan.frames[*i])).collect::<Result<Vec<_>, _>>()?;
        let pictures = opened.iter().map(|frame| frame.needed(FrameFile::Rgb)).collect::<Result<Vec<_>, _>>()?;
        let first = &plan.frames[frames[0]];
        let name = format!("{}/{}_v{:02}_{}.mp4", first.split, first.scene, first.variation, first.view);
        let times: Vec<i64> = opened.iter().map(|frame| frame.table.keyframe_time_ns).collect();
        let seconds = times.last().zip(times.first()).map_or(0.0, |(last, first)| (last - first) as f64 / 1e9);
        let rate_hz = if seconds > 0.0 { (times.len() - 1) as f64 / seconds } else { ALONE_HZ };
        let program = std::env::var_os("TROVE_FFMPEG").unwrap_or_else(|| OsString::from("ffmpeg"));
        unit.external(&name, |file| {
            let picture = |path: &PathBuf| read_regular(path, LARGEST_FILE);
            encode(&program, rate_hz, pictures.iter().map(picture), file)
        })
    }
}

fn encode(
    program: &OsString,
    rate_hz: f64,
    pictures: impl Iterator<Item = io::Result<Vec<u8>>>,
    file: &Path,
) -> io::Result<()> {
    let shown = program.to_string_lossy();
    let mut ffmpeg = Command::new(program)
        .args(["-loglevel", "error", "-y", "-f", "image2pipe", "-c:v", "png", "-framerate", &format!("{rate_hz:.6}")])
        // H.264 has even sizes; the last row or column is left out where there is an odd one.
        .args(["-i", "-", "-vf", "crop=trunc(iw/2)*2:trunc(ih/2)*2", "-c:v", "libx264", "-pix_fmt", "yuv420p"])
        .args(["-crf", "16", "-threads", "1", "-movflags", "+faststart", "-f", "mp4"])
        .arg(file)
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|e| {
            io::Error::new(e.kind(), format!("{shown} cannot be run ({e}); install ffmpeg, or set TROVE_FFMPEG"))
        })?;
    let mut fed = Ok(());
    if let Some(mut input) = ffmpeg.stdin.take() {
        for picture in pictures {
            fed = picture.and_then(|bytes| input.write_all(&bytes));
            if fed.is_err() {
                break;
            }
        }
    }
    let done = ffmpeg.wait_with_output()?;
    if !done.status.success() {
        let why = String::from_utf8_lossy(&done.stderr);
        return Err(io::Error::other(format!("{shown} failed: {}", why.trim())));
    }
    fed
}
