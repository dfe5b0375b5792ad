//! A page and what lies beside it, for browsers that let no page read files.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::{Component, Path, PathBuf};
use std::time::Duration;

use anyhow::{Context, Result};
use trove_files::{LARGEST_FILE, read_regular};

use crate::watch::Watch;

/// A longer request is none of a browser's for these files, bytes.
const LONGEST_REQUEST: u64 = 16_384;
/// Between looks at whether an end was asked for.
const PAUSE: Duration = Duration::from_millis(50);
/// For a browser that has opened a connection and asks for nothing.
const PATIENCE: Duration = Duration::from_secs(10);

/// Serves the page to this machine alone until an end is asked for.
pub(super) fn serve(page: &Path, folder: &Path, watch: &Watch) -> Result<()> {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).context("expected a free port on 127.0.0.1")?;
    listener.set_nonblocking(true)?;
    let name = page.file_name().unwrap_or_default().to_string_lossy();
    println!("http://{}/{}  (Ctrl-C ends)", listener.local_addr()?, encoded(&name));
    while !watch.stops() {
        match listener.accept() {
            Ok((stream, _)) => {
                let (page, folder) = (page.to_owned(), folder.to_owned());
                // A browser that goes away in the middle is no fault.
                std::thread::spawn(move || answer(stream, &page, &folder).unwrap_or_default());
            }
            Err(_) => std::thread::sleep(PAUSE),
        }
    }
    Ok(())
}

fn answer(mut stream: TcpStream, page: &Path, folder: &Path) -> std::io::Result<()> {
    stream.set_nonblocking(false)?;
    stream.set_read_timeout(Some(PATIENCE))?;
    let mut reader = BufReader::new((&stream).take(LONGEST_REQUEST));
    let mut request = String::new();
    reader.read_line(&mut request)?;
    loop {
        let mut line = String::new();
        if reader.read_line(&mut line)? == 0 || line.trim().is_empty() {
            break;
        }
    }
    let mut words = request.split_whitespace();
    let asked = match (words.next(), words.next()) {
        (Some("GET"), Some(path)) => file(path, page, folder),
        _ => None,
    };
    let found = asked.and_then(|path| Some((read_regular(&path, LARGEST_FILE).ok()?, kind(&path))));
    let (status, kind, content) = match &found {
        Some((content, kind)) => ("200 OK", *kind, content.as_slice()),
        None => ("404 Not Found", "text/plain", b"not found\n".as_slice()),
    };
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nConnection: close\r\n\r\n",
        content.len()
    )?;
    stream.write_all(content)
}

/// The file that a request means: the page, or one in its folder; nothing else.
fn file(path: &str, page: &Path, folder: &Path) -> Option<PathBuf> {
    let path = decoded(path.split(['?', '#']).next()?)?;
    let path = Path::new(path.strip_prefix('/')?);
    if path.as_os_str().is_empty() || Some(path.as_os_str()) == page.file_name() {
        return Some(page.to_owned());
    }
    let inside = path.strip_prefix(folder.file_name()?).ok()?;
    inside.components().all(|part| matches!(part, Component::Normal(_))).then(|| folder.join(inside))
}

fn kind(path: &Path) -> &'static str {
    if path.extension().is_some_and(|ending| ending == "js") {
        "text/javascript; charset=utf-8"
    } else {
        "text/html; charset=utf-8"
    }
}

fn encoded(name: &str) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-._~".contains(&byte);
    name.bytes().map(|byte| if plain(byte) { (byte as char).to_string() } else { format!("%{byte:02X}") }).collect()
}

fn decoded(path: &str) -> Option<String> {
    let mut bytes = Vec::new();
    let mut rest = path.bytes();
    while let Some(byte) = rest.next() {
        if byte == b'%' {
            let digits = [rest.next()?, rest.next()?];
            bytes.push(u8::from_str_radix(std::str::from_utf8(&digits).ok()?, 16).ok()?);
        } else {
            bytes.push(byte);
        }
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_page_and_its_folder_are_served() {
        let (page, folder) = (Path::new("/out/my page.html"), Path::new("/out/my page.frames"));
        let asked = |path| file(path, page, folder);
        assert_eq!(asked("/my%20page.html?x#y"), Some(page.into()));
        assert_eq!(asked("/"), Some(page.into()));
        assert_eq!(asked("/my%20page.frames/s/v00.js"), Some(folder.join("s/v00.js")));
        for outside in
            ["/secret", "/my%20page.frames/../secret", "/my%20page.frames/%2e%2e/secret", "my", "//etc/passwd"]
        {
            assert_eq!(asked(outside), None, "{outside}");
        }
        assert_eq!(decoded(&encoded("a b%.html")), Some("a b%.html".into()));
    }
}
