//! `make fuzz`: feeds every target with damage, for some seconds each, and keeps what breaks one.
//!
//! A panic, an input that takes over ten seconds, and a process that takes over 2 GB are faults: the input is kept in
//! `fuzz/artifacts`, the command to repeat it is printed, and the status is 1. What ends the process itself is found
//! there too, as `under-way-…`.

use std::fs;
use std::panic::{self, AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::process::exit;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use trove_fuzz::mutator::{Draw, mutated};
use trove_fuzz::{TARGETS, Target, target};

const USAGE: &str = "usage: fuzz [--seconds N] [--seed N] [TARGET ...]\n       fuzz --repeat TARGET FILE";
/// An input that takes longer is a fault.
const SLOWEST: Duration = Duration::from_secs(10);
/// A process that takes more is a fault, bytes.
const MOST_MEMORY: u64 = 2 << 30;

/// As the main thread has, on which recipes and tables are read.
const STACK_BYTES: usize = 8 << 20;

/// Larger files of the corpus are read, but not mutated.
const LARGEST_SEED: usize = 4 << 10;

/// Panics so far, also those that a reader has caught; and where the last one was.
static PANICS: AtomicUsize = AtomicUsize::new(0);
static LAST_PANIC: Mutex<String> = Mutex::new(String::new());

struct Options {
    seconds: u64,
    seed: u64,
    targets: Vec<&'static Target>,
}

/// What a worker feeds, and since when.
type UnderWay = Option<(Instant, Vec<u8>)>;

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    watch_panics();
    if let [flag, name, file] = args.as_slice()
        && flag == "--repeat"
    {
        let (Some(target), Ok(data)) = (target(name), fs::read(file)) else { give_up(USAGE) };
        let started = Instant::now();
        feed_once(target, &data);
        println!("{name}: {:.2} s, {} MB at most", started.elapsed().as_secs_f64(), peak_memory() >> 20);
        return;
    }
    let options = options(&args).unwrap_or_else(|| give_up(USAGE));
    let (mut inputs, started) = (0, Instant::now());
    for target in &options.targets {
        inputs += fuzz(target, &options);
    }
    println!("{inputs} inputs in {:.0} s, {} MB at most", started.elapsed().as_secs_f64(), peak_memory() >> 20);
}

fn options(args: &[String]) -> Option<Options> {
    let mut options = Options { seconds: 10, seed: 1, targets: Vec::new() };
    let mut args = args.iter();
    while let Some(arg) = args.next() {
        match arg.as_str() {
            "--seconds" => options.seconds = args.next()?.parse().ok()?,
            "--seed" => options.seed = args.next()?.parse().ok()?,
            name => options.targets.push(target(name)?),
        }
    }
    if options.targets.is_empty() {
        options.targets = TARGETS.iter().collect();
    }
    Some(options)
}

fn give_up(why: &str) -> ! {
    eprintln!("{why}");
    exit(2)
}

/// Feeds one target; how many inputs it got.
fn fuzz(target: &'static Target, options: &Options) -> u64 {
    let _ = fs::create_dir_all(artifacts(target));
    let kept = corpus(target);
    // What is mutated is small, or few mutations would be tried.
    let small = kept.iter().filter(|data| data.len() <= LARGEST_SEED).cloned();
    let inputs: Vec<Vec<u8>> = (target.seeds)().into_iter().chain(small).collect();
    let workers = thread::available_parallelism().map_or(1, |n| n.get());
    let (fed, is_over) = (AtomicU64::new(0), AtomicBool::new(false));
    let under_way: Vec<Mutex<UnderWay>> = (0..workers).map(|_| Mutex::new(None)).collect();
    let deadline = Instant::now() + Duration::from_secs(options.seconds);
    thread::scope(|threads| {
        let running: Vec<_> = under_way
            .iter()
            .enumerate()
            .map(|(worker, under_way)| {
                let (inputs, kept, fed) = (&inputs, &kept, &fed);
                let worker_thread = thread::Builder::new().stack_size(STACK_BYTES);
                let spawned = worker_thread.spawn_scoped(threads, move || {
                    let folder = tempfile::tempdir().expect("a temporary folder");
                    (target.prepare)(folder.path());
                    let under_way_file = artifacts(target).join(format!("under-way-{worker}"));
                    let mut draw = Draw::new(options.seed.wrapping_mul(1_000_003).wrapping_add(worker as u64));
                    // What once failed comes first, then what is valid.
                    let mut first =
                        kept.iter().chain(inputs).filter(|_| worker == 0).cloned().collect::<Vec<_>>().into_iter();
                    loop {
                        let next = first.next();
                        if next.is_none() && Instant::now() > deadline {
                            break;
                        }
                        let data = next.unwrap_or_else(|| mutated(inputs, &mut draw));
                        *under_way.lock().expect("no worker panics with it") = Some((Instant::now(), data.clone()));
                        // Whatever ends the process leaves it there: an overflowing stack, a fault of a library in C.
                        let _ = fs::write(&under_way_file, &data);
                        feed(target, folder.path(), &data);
                        *under_way.lock().expect("no worker panics with it") = None;
                        fed.fetch_add(1, Ordering::Relaxed);
                    }
                    let _ = fs::remove_file(under_way_file);
                });
                spawned.expect("a thread can be started")
            })
            .collect();
        threads.spawn(|| {
            while !is_over.load(Ordering::Relaxed) {
                thread::sleep(Duration::from_millis(200));
                for slot in &under_way {
                    let slot = slot.lock().expect("no worker panics with it");
                    if let Some((_, data)) = slot.as_ref().filter(|(since, _)| since.elapsed() > SLOWEST) {
                        fail(target, data, "takes over 10 s");
                    }
                }
            }
        });
        running.into_iter().for_each(|worker| worker.join().expect("workers catch panics"));
        is_over.store(true, Ordering::Relaxed);
    });
    let fed = fed.into_inner();
    println!("{:18} {fed:8} inputs, {:5} MB at most", target.name, peak_memory() >> 20);
    fed
}

fn feed(target: &Target, folder: &Path, data: &[u8]) {
    let before = PANICS.load(Ordering::Relaxed);
    let _ = catch_unwind(AssertUnwindSafe(|| (target.feed)(folder, data)));
    if PANICS.load(Ordering::Relaxed) > before {
        let last = LAST_PANIC.lock().map(|text| text.clone()).unwrap_or_default();
        fail(target, data, &last);
    }
    if peak_memory() > MOST_MEMORY {
        fail(target, data, "took the process over 2 GB");
    }
}

/// In this thread, with what is said printed.
fn feed_once(target: &'static Target, data: &[u8]) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    (target.prepare)(folder.path());
    feed(target, folder.path(), data);
}

/// Counts panics. Draco's decoder is expected to panic on damage, and its reader catches that.
fn watch_panics() {
    panic::set_hook(Box::new(|panic| {
        let place = panic.location().map(ToString::to_string).unwrap_or_default();
        if place.contains("draco-core") {
            return;
        }
        if let Ok(mut last) = LAST_PANIC.lock() {
            *last = panic.to_string();
        }
        PANICS.fetch_add(1, Ordering::Relaxed);
    }));
}

/// Keeps an input and ends.
fn fail(target: &Target, data: &[u8], why: &str) -> ! {
    let folder = artifacts(target);
    let sum = data.iter().fold(0xcbf2_9ce4_8422_2325u64, |h, &b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3));
    let path = folder.join(format!("{sum:016x}"));
    let kept = fs::create_dir_all(&folder).and_then(|()| fs::write(&path, data));
    eprintln!("{}: {why}", target.name);
    match kept {
        Ok(()) => {
            eprintln!("repeat it: cargo run -p trove-fuzz --bin fuzz -- --repeat {} {}", target.name, path.display());
            eprintln!("once it is mended, move it to fuzz/corpus/{}", target.name);
        }
        Err(error) => eprintln!("{}: cannot be kept: {error}", path.display()),
    }
    exit(1)
}

/// Where inputs that failed are put.
fn artifacts(target: &Target) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("artifacts").join(target.name)
}

/// What is kept of a target, by name.
fn corpus(target: &Target) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus").join(target.name);
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    files.sort();
    files.iter().filter_map(|file| fs::read(file).ok()).collect()
}

/// The most memory that this process has had, bytes; 0 where the system does not tell.
fn peak_memory() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|rest| rest.split_whitespace().next()?.parse::<u64>().ok()).unwrap_or(0) << 10
}
