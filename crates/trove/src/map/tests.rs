//! `trove map` against a server of the test's own, on the loopback.

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::PathBuf;
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use tempfile::TempDir;
use trove_read::osm::GeoExtent;

use super::overpass::{Patience, Server, query};
use super::{MapCommand, fetch, names, told};
use crate::recipe::Recipe;

const HELSINKI: GeoExtent =
    GeoExtent { min_lat_deg: 60.1681, max_lat_deg: 60.1735, min_lon_deg: 24.936, max_lon_deg: 24.9468 };

/// A reply as Overpass writes it.
const WHOLE: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<osm version="0.6" generator="Overpass API 0.7.62">
<note>The data included in this document is from www.openstreetmap.org. The data is made available under ODbL.</note>
<meta osm_base="2024-05-01T12:00:00Z"/>
  <bounds minlat="60.1681" minlon="24.936" maxlat="60.1735" maxlon="24.9468"/>
  <node id="1" lat="60.17" lon="24.94"/>
  <node id="2" lat="60.171" lon="24.941"/>
  <way id="7"><nd ref="1"/><nd ref="2"/><tag k="highway" v="residential"/></way>
</osm>
"#;

fn with_length(status: &str, headers: &str, body: &str, length: usize) -> String {
    format!("HTTP/1.1 {status}\r\nContent-Length: {length}\r\n{headers}Connection: close\r\n\r\n{body}")
}

fn reply(status: &str, headers: &str, body: &str) -> String {
    with_length(status, headers, body, body.len())
}

fn ok(body: &str) -> String {
    reply("200 OK", "Content-Type: application/osm3s+xml\r\n", body)
}

/// What a server does with one request.
#[derive(Clone)]
enum Answer {
    /// This, and closes.
    Says(String),
    /// This, and then more of the same until nobody listens.
    SaysOn(String),
    /// Nothing for this long, and closes.
    IsSilent(Duration),
}

/// A request as it came, and when.
#[derive(Clone, Debug)]
struct Asked {
    head: String,
    body: String,
    at: Instant,
}

/// A server that gives some answers one after another, and the last one ever after.
struct Loopback {
    endpoint: String,
    asked: Arc<Mutex<Vec<Asked>>>,
}

impl Loopback {
    fn new(answers: Vec<Answer>) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let endpoint = format!("http://{}/api/interpreter", listener.local_addr().unwrap());
        let asked: Arc<Mutex<Vec<Asked>>> = Arc::default();
        let heard = asked.clone();
        // It ends with the test's process.
        thread::spawn(move || {
            for (i, stream) in listener.incoming().enumerate() {
                let mut stream = stream.unwrap();
                heard.lock().unwrap().push(request(&mut stream));
                let answer = answers[i.min(answers.len() - 1)].clone();
                // Whoever asks again while it is silent is answered.
                thread::spawn(move || match answer {
                    Answer::Says(text) => drop(stream.write_all(text.as_bytes())),
                    Answer::SaysOn(text) => {
                        let mut said = stream.write_all(text.as_bytes());
                        while said.is_ok() {
                            said = stream.write_all(&[b' '; 1 << 16]);
                        }
                    }
                    Answer::IsSilent(time) => thread::sleep(time),
                });
            }
        });
        Self { endpoint, asked }
    }

    fn asked(&self) -> Vec<Asked> {
        self.asked.lock().unwrap().clone()
    }
}

fn request(stream: &mut TcpStream) -> Asked {
    let mut reader = BufReader::new(stream);
    let (mut head, mut length) = (String::new(), 0);
    loop {
        let mut line = String::new();
        reader.read_line(&mut line).unwrap();
        if let Some(value) = line.to_lowercase().strip_prefix("content-length:") {
            length = value.trim().parse().unwrap();
        }
        if line.trim().is_empty() {
            break;
        }
        head += &line;
    }
    let mut body = vec![0; length];
    reader.read_exact(&mut body).unwrap();
    Asked { head, body: String::from_utf8(body).unwrap(), at: Instant::now() }
}

fn patience() -> Patience {
    Patience {
        tries: 3,
        first_wait: Duration::from_millis(20),
        longest_wait: Duration::from_secs(10),
        connect: Duration::from_secs(5),
        response: Duration::from_millis(400),
        body: Duration::from_secs(5),
        largest: 1 << 20,
    }
}

/// What fetching gives, with the names of what lies in the folder afterwards and what the server heard.
struct Fetched {
    result: anyhow::Result<String>,
    left: Vec<String>,
    asked: Vec<Asked>,
}

fn fetched(answers: Vec<Answer>) -> Fetched {
    let (folder, loopback) = (tempfile::tempdir().unwrap(), Loopback::new(answers));
    let file = folder.path().join("map.osm");
    let server = Server::new(&loopback.endpoint, patience()).unwrap();
    let result = fetch(&server, HELSINKI, &file, None, false).map(|()| fs::read_to_string(&file).unwrap());
    Fetched { result, left: names_in(&folder), asked: loopback.asked() }
}

fn names_in(folder: &TempDir) -> Vec<String> {
    fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect()
}

#[test]
fn a_whole_reply_is_kept_as_it_is_and_the_server_knows_who_asks_for_what() {
    let Fetched { result, left, asked } = fetched(vec![Answer::Says(ok(WHOLE))]);
    assert_eq!(result.unwrap(), WHOLE, "the attribution is kept");
    assert_eq!(left, ["map.osm"]);
    assert_eq!(asked.len(), 1);
    let head = asked[0].head.to_lowercase();
    assert!(head.starts_with("post /api/interpreter "), "{head}");
    assert!(head.contains(&format!("user-agent: trove/{}\r\n", env!("CARGO_PKG_VERSION"))), "{head}");
    assert!(asked[0].body.starts_with("data=%5Bout%3Axml%5D"), "{}", asked[0].body);
    assert!(asked[0].body.contains("60.1681%2C24.9360%2C60.1735%2C24.9468"), "{}", asked[0].body);
}

#[test]
fn what_passes_is_waited_for() {
    let pass = |answer: Answer, least: Duration| {
        let Fetched { result, left, asked } = fetched(vec![answer, Answer::Says(ok(WHOLE))]);
        assert_eq!(result.unwrap(), WHOLE);
        assert_eq!((left, asked.len()), (vec!["map.osm".to_owned()], 2));
        assert!(asked[1].at - asked[0].at >= least, "{:?}", asked[1].at - asked[0].at);
    };
    let short = Duration::from_millis(20);
    pass(Answer::Says(reply("429 Too Many Requests", "Retry-After: 1\r\n", "slow down")), Duration::from_secs(1));
    pass(Answer::Says(reply("429 Too Many Requests", "Retry-After: Wed, 21 Oct 2015 07:28:00 GMT\r\n", "")), short);
    pass(Answer::Says(reply("504 Gateway Timeout", "", "<html>too busy</html>")), short);
    pass(Answer::Says(reply("503 Service Unavailable", "Retry-After: 0\r\n", "")), short);
    // Cut off within the XML, and before the length that was promised.
    pass(Answer::Says(ok(&WHOLE[..400])), short);
    pass(Answer::Says(with_length("200 OK", "", WHOLE, WHOLE.len() + 100)), short);
    pass(Answer::Says(with_length("200 OK", "", WHOLE, WHOLE.len() - 100)), short);
    pass(Answer::Says(ok("")), short);
    pass(Answer::Says(String::new()), short);
    pass(Answer::IsSilent(Duration::from_millis(1500)), Duration::from_millis(400));
    let busy = WHOLE.replace("</osm>", "<remark> runtime error: open64: 0 Success /osm3s_osm_base Dispatcher_Client::request_read_and_idle::timeout. </remark></osm>");
    pass(Answer::Says(ok(&busy)), short);
}

#[test]
fn tries_come_later_and_later_and_end() {
    let Fetched { result, left, asked } = fetched(vec![Answer::Says(reply("504 Gateway Timeout", "", ""))]);
    let error = result.unwrap_err().to_string();
    assert!(error.contains("504") && error.contains("3 times") && error.contains("--endpoint"), "{error}");
    assert_eq!((left.len(), asked.len()), (0, 3));
    assert!(asked[2].at - asked[1].at >= Duration::from_millis(40));
    // An hour is too long.
    let long = reply("429 Too Many Requests", "Retry-After: 3600\r\n", "");
    let Fetched { result, asked, .. } = fetched(vec![Answer::Says(long)]);
    let error = result.unwrap_err().to_string();
    assert!(error.contains("3600 s") && asked.len() == 1, "{error}");
}

#[test]
fn what_does_not_pass_is_told_at_once_and_leaves_nothing() {
    let check = |answer: Answer, parts: &[&str]| {
        let Fetched { result, left, asked } = fetched(vec![answer]);
        let error = format!("{:#}", result.unwrap_err());
        assert!(parts.iter().all(|part| error.contains(part)), "{error}: expected {parts:?}");
        assert_eq!((left, asked.len()), (vec![], 1), "{error}");
    };
    let html = "<!DOCTYPE html><html><body>Welcome \u{1b}[2J</body></html>";
    check(Answer::Says(ok(html)), &["expected OpenStreetMap XML", "Welcome \\u{1b}[2J", "address of an Overpass API"]);
    check(Answer::Says(reply("400 Bad Request", "", "parse error: ';' expected")), &["400", "parse error"]);
    check(Answer::Says(reply("404 Not Found", "", "")), &["404"]);
    let moved = reply("301 Moved Permanently", "Location: https://example.org/api\r\n", "");
    check(Answer::Says(moved), &["301", "https://example.org/api", "--endpoint"]);
    check(Answer::SaysOn("HTTP/1.1 200 OK\r\n\r\n<osm>".into()), &["at most 1048576 bytes", "fewer scenes"]);
    let remark = "<remark> runtime error: Query timed out in \"recurse\" at line 1 after 181 seconds. </remark></osm>";
    check(Answer::Says(ok(&WHOLE.replace("</osm>", remark))), &["Query timed out", "fewer scenes"]);
    check(Answer::Says(ok("<osm version=\"0.6\"></osm>")), &["nothing is mapped there"]);
    // Our own reader has to read it.
    check(Answer::Says(ok(&WHOLE.replace("<way", "<wa<y"))), &["the reply of http://127.0.0.1", "well-formed XML"]);
    check(Answer::Says(ok(&WHOLE.replace(" lat=", " lot="))), &["nodes that have coordinates"]);
}

#[test]
fn a_reply_that_comes_too_slowly_is_given_up() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let endpoint = format!("http://{}/", listener.local_addr().unwrap());
    thread::spawn(move || {
        for stream in listener.incoming() {
            let mut stream = stream.unwrap();
            request(&mut stream);
            let mut said = stream.write_all(b"HTTP/1.1 200 OK\r\n\r\n<osm>");
            while said.is_ok() {
                thread::sleep(Duration::from_millis(30));
                said = stream.write_all(b" ");
            }
        }
    });
    let patience = Patience { tries: 2, body: Duration::from_millis(300), ..patience() };
    let (server, started) = (Server::new(&endpoint, patience).unwrap(), Instant::now());
    let error = server.fetch("x").unwrap_err().to_string();
    assert!(error.contains("broke off after") && error.contains("2 times"), "{error}");
    assert!(started.elapsed() < Duration::from_secs(20), "{:?}", started.elapsed());
}

#[test]
fn a_server_that_is_not_there_and_an_address_that_is_none_are_told() {
    let port = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
    let server = Server::new(&format!("http://127.0.0.1:{port}/"), patience()).unwrap();
    let error = server.fetch("x").unwrap_err().to_string();
    assert!(error.contains("3 times") && error.contains(&port.to_string()), "{error}");
    for endpoint in ["", "overpass", "ftp://example.org", "file:///etc/passwd"] {
        let error = Server::new(endpoint, patience()).map(drop).unwrap_err().to_string();
        assert!(error.contains("--endpoint"), "{error}");
    }
    // Certificates are those of this system; they are looked for before anything is asked.
    if let Err(error) = Server::new("https://127.0.0.1:9/", patience()) {
        assert!(error.to_string().contains("ca-certificates"), "{error}");
    }
}

#[test]
fn the_same_box_is_asked_for_once_and_a_damaged_cache_is_made_anew() {
    let folder = tempfile::tempdir().unwrap();
    let cache = folder.path().join("cache/maps");
    let loopback = Loopback::new(vec![Answer::Says(ok(WHOLE))]);
    let server = Server::new(&loopback.endpoint, patience()).unwrap();
    let get = |name: &str, extent: GeoExtent, refresh: bool| {
        let file = folder.path().join(name);
        fetch(&server, extent, &file, Some(&cache), refresh).unwrap();
        assert_eq!(fs::read_to_string(file).unwrap(), WHOLE);
        loopback.asked().len()
    };
    assert_eq!(get("a.osm", HELSINKI, false), 1);
    assert_eq!(get("new folder/b.osm", HELSINKI, false), 1);
    assert_eq!(get("a.osm", HELSINKI, true), 2);
    assert_eq!(get("a.osm", GeoExtent { max_lat_deg: 60.2, ..HELSINKI }, false), 3);
    for kept in fs::read_dir(&cache).unwrap() {
        fs::write(kept.unwrap().path(), &WHOLE[..300]).unwrap();
    }
    assert_eq!(get("a.osm", HELSINKI, false), 4);
    assert_eq!(get("a.osm", HELSINKI, false), 4);
}

#[test]
fn what_was_there_stays_where_nothing_whole_comes() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("map.osm");
    fs::write(&file, "mine").unwrap();
    let loopback = Loopback::new(vec![Answer::Says(ok(&WHOLE.replace("<way", "<wa<y")))]);
    let server = Server::new(&loopback.endpoint, patience()).unwrap();
    assert!(fetch(&server, HELSINKI, &file, None, false).is_err());
    assert_eq!((fs::read_to_string(&file).unwrap().as_str(), names_in(&folder)), ("mine", vec!["map.osm".to_owned()]));
}

#[test]
fn a_box_across_the_antimeridian_ends_west_of_where_it_begins() {
    let fiji = GeoExtent { min_lat_deg: -17.0, max_lat_deg: -16.9, min_lon_deg: 179.95, max_lon_deg: 180.05 };
    assert!(query(fiji).contains("[bbox:-17.0000,179.9500,-16.9000,-179.9500]"), "{}", query(fiji));
    assert!(query(HELSINKI).contains("[bbox:60.1681,24.9360,60.1735,24.9468]"), "{}", query(HELSINKI));
}

#[test]
fn files_are_named_as_the_recipe_would_name_them() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("recipe.toml");
    fs::create_dir(folder.path().join("maps")).unwrap();
    fs::write(&path, "[place]\nlat_deg = 60.17\nlon_deg = 24.94\n[map]\nosm = \"maps/a.osm\"\n").unwrap();
    let recipe = Recipe::read(&path).unwrap();
    assert_eq!(told(&recipe, &folder.path().join("maps/a.osm")), "maps/a.osm");
    let elsewhere = tempfile::tempdir().unwrap();
    let file = elsewhere.path().canonicalize().unwrap().join("b.osm");
    fs::write(&file, "").unwrap();
    assert_eq!(PathBuf::from(told(&recipe, &file)), file);
    let out = PathBuf::from("maps/city.osm");
    assert_eq!(names(&out, 1), std::slice::from_ref(&out));
    assert_eq!(names(&out, 2), [PathBuf::from("maps/city-1.osm"), PathBuf::from("maps/city-2.osm")]);
}

#[test]
fn the_command_writes_what_the_recipe_s_place_needs() {
    let folder = tempfile::tempdir().unwrap();
    let (recipe, out) = (folder.path().join("recipe.toml"), folder.path().join("maps/helsinki.osm"));
    fs::write(&recipe, "[place]\nlat_deg = 60.1708\nlon_deg = 24.9414\n[map]\nosm = \"maps/helsinki.osm\"\n").unwrap();
    let loopback = Loopback::new(vec![Answer::Says(ok(WHOLE))]);
    let usage = ["trove", "map", recipe.to_str().unwrap()].map(std::ffi::OsString::from);
    assert_eq!(crate::main(usage, &[]), 2, "without --out or --dry-run");
    let command = |dry_run, json| MapCommand {
        recipe: recipe.clone(),
        out: Some(out.clone()),
        endpoint: loopback.endpoint.clone(),
        dry_run,
        refresh: false,
        json,
    };
    command(true, false).run_with(None).unwrap();
    command(true, true).run_with(None).unwrap();
    assert!(loopback.asked().is_empty() && !out.exists());
    command(false, false).run_with(Some(folder.path())).unwrap();
    command(false, true).run_with(Some(folder.path())).unwrap();
    assert_eq!((fs::read_to_string(&out).unwrap().as_str(), loopback.asked().len()), (WHOLE, 1));
    // 400 m and a margin of 100 m on each side, outwards to a ten-thousandth of a degree.
    assert!(loopback.asked()[0].body.contains("60.1681%2C24.9359%2C60.1735%2C24.9469"), "{:?}", loopback.asked());
}
