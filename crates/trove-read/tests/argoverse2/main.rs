//! The Argoverse 2 reader, on small logs that the tests write and on the real one.

#![allow(clippy::unwrap_used)] // the lint knows test functions, not the functions that they share

mod bad_input;
mod fixture;
mod real;
mod small;
mod utm;

#[path = "../../../../fuzz/src/argoverse2.rs"]
mod tmpfuzz;
#[test]
fn tmp() {
    let d = tempfile::tempdir().unwrap();
    tmpfuzz::prepare(d.path());
    let mut s = 12345u64;
    let mut r = || {
        s ^= s << 13;
        s ^= s >> 7;
        s ^= s << 17;
        s as usize
    };
    let end = std::time::Instant::now() + std::time::Duration::from_secs(90);
    let mut n = 0;
    while std::time::Instant::now() < end {
        for (seeds, feed) in [
            (tmpfuzz::feather_seeds(), tmpfuzz::feed_feather as fn(&std::path::Path, &[u8])),
            (tmpfuzz::height_seeds(), tmpfuzz::feed_height),
            (tmpfuzz::map_seeds(), tmpfuzz::feed_map),
        ] {
            for mut b in seeds {
                for _ in 0..1 + r() % 4 {
                    let i = r() % b.len();
                    let v = [0u8, 1, 2, 4, 8, 16, 0x7f, 0x80, 0xfe, 0xff][r() % 10];
                    let c = 1 + r() % 8;
                    let e = (i + c).min(b.len());
                    b[i.max(1)..e.max(i.max(1))].fill(v);
                }
                feed(d.path(), &b);
                n += 1;
            }
        }
    }
    println!("fed {n}");
}
