//! The Overpass API, asked politely: one request at a time, and longer and longer waits where it is busy.

use std::io::Read;
use std::sync::Arc;
use std::thread::sleep;
use std::time::Duration;

use anyhow::{Result, anyhow, bail, ensure};
use trove_read::osm::GeoExtent;
use ureq::http::{Response, StatusCode};
use ureq::tls::{Certificate, RootCerts, TlsConfig};
use ureq::{Agent, Body, Error};

use super::extract::largest;
use crate::message::shown;

/// By which the server knows the program.
const USER_AGENT: &str = concat!("trove/", env!("CARGO_PKG_VERSION"));
/// What the server itself may take, seconds, and the memory that it may use, bytes.
const SERVER_S: u64 = 180;
const SERVER_BYTES: u64 = 1 << 30;
/// Characters of a reply that are quoted.
const QUOTED: usize = 200;

/// How long to wait for what.
#[derive(Clone, Debug)]
pub(super) struct Patience {
    pub(super) tries: u32,
    /// Before the second try; doubled before each further one.
    pub(super) first_wait: Duration,
    /// A server that asks for longer is given up.
    pub(super) longest_wait: Duration,
    pub(super) connect: Duration,
    /// Until the reply begins.
    pub(super) response: Duration,
    /// Until it has ended.
    pub(super) body: Duration,
    pub(super) largest: u64,
}

impl Default for Patience {
    fn default() -> Self {
        Self {
            tries: 5,
            first_wait: Duration::from_secs(5),
            longest_wait: Duration::from_secs(300),
            connect: Duration::from_secs(30),
            response: Duration::from_secs(SERVER_S + 60),
            body: Duration::from_secs(900),
            largest: largest(),
        }
    }
}

/// What asks for everything in a box, and for the nodes and edges outside it of what leads out of it.
pub(super) fn query(extent: GeoExtent) -> String {
    let GeoExtent { min_lat_deg, max_lat_deg, min_lon_deg, max_lon_deg } = extent;
    let west = (min_lon_deg + 540.0).rem_euclid(360.0) - 180.0;
    // East of the antimeridian it is less than west.
    let east = if max_lon_deg > 180.0 { max_lon_deg - 360.0 } else { max_lon_deg };
    format!(
        "[out:xml][timeout:{SERVER_S}][maxsize:{SERVER_BYTES}][bbox:{min_lat_deg:.4},{west:.4},{max_lat_deg:.4},{east:.4}];\
         (node;way;relation[type=multipolygon];relation[type=building];);(._;>;);out body;"
    )
}

/// A server of the Overpass API.
pub(super) struct Server {
    endpoint: String,
    agent: Agent,
    patience: Patience,
}

/// Why a try gave nothing.
enum Failure {
    /// Another one may succeed, after so long if the server says so.
    Busy(String, Option<Duration>),
    Final(anyhow::Error),
}

impl Server {
    pub(super) fn new(endpoint: &str, patience: Patience) -> Result<Self> {
        let is_https = endpoint.starts_with("https://");
        ensure!(
            is_https || endpoint.starts_with("http://"),
            "--endpoint: expected the address of an Overpass API (https://…/api/interpreter), found {endpoint:?}"
        );
        let mut config = Agent::config_builder()
            .http_status_as_error(false)
            // A form is not sent on with them, and whoever is asked is named by the user.
            .max_redirects(0)
            .max_redirects_will_error(false)
            .user_agent(USER_AGENT)
            .timeout_connect(Some(patience.connect))
            .timeout_recv_response(Some(patience.response))
            .timeout_recv_body(Some(patience.body));
        if ["//127.", "//localhost", "//[::1]"].iter().any(|host| endpoint.contains(host)) {
            config = config.proxy(None);
        }
        if is_https {
            config = config.tls_config(tls()?);
        }
        Ok(Self { endpoint: endpoint.to_owned(), agent: config.build().new_agent(), patience })
    }

    pub(super) fn endpoint(&self) -> &str {
        &self.endpoint
    }

    /// The whole reply to a query, which is an OpenStreetMap file.
    pub(super) fn fetch(&self, query: &str) -> Result<Vec<u8>> {
        let Patience { tries, first_wait, longest_wait, .. } = self.patience;
        let mut wait = first_wait;
        for number in 1.. {
            let (why, asked) = match self.once(query) {
                Ok(bytes) => return Ok(bytes),
                Err(Failure::Final(error)) => return Err(error.context(self.endpoint.clone())),
                Err(Failure::Busy(why, asked)) => (shown(&why), asked),
            };
            let pause = asked.unwrap_or(wait).max(wait);
            let gives_up = format!("{}: expected a map, found: {why}", self.endpoint);
            ensure!(
                number < tries,
                "{gives_up}, {tries} times; try again later, or name another server with --endpoint"
            );
            ensure!(
                pause <= longest_wait,
                "{gives_up}; it asks for {} s of patience: try again then, or name another server with --endpoint",
                pause.as_secs()
            );
            tracing::warn!("{}: {why}; next try in {} s", self.endpoint, pause.as_secs());
            sleep(pause);
            wait *= 2;
        }
        bail!("{}: not tried", self.endpoint)
    }

    fn once(&self, query: &str) -> Result<Vec<u8>, Failure> {
        let mut response = self.agent.post(&self.endpoint).send_form([("data", query)]).map_err(failure)?;
        let status = response.status();
        if status != StatusCode::OK {
            return Err(refusal(status, &mut response));
        }
        let mut bytes = Vec::new();
        let most = self.patience.largest;
        if let Err(error) = response.body_mut().as_reader().take(most + 1).read_to_end(&mut bytes) {
            return Err(Failure::Busy(format!("the reply broke off after {} bytes: {error}", bytes.len()), None));
        }
        if bytes.len() as u64 > most {
            return Err(Failure::Final(anyhow!(
                "expected a reply of at most {most} bytes, found a larger one; name fewer scenes in drive.scenes"
            )));
        }
        whole(&bytes).map(|()| bytes)
    }
}

/// The certificates that this system trusts.
fn tls() -> Result<TlsConfig> {
    // Whoever was first is as good.
    let _ = rustls::crypto::ring::default_provider().install_default();
    let found = rustls_native_certs::load_native_certs();
    let certificates: Vec<Certificate<'static>> =
        found.certs.iter().map(|der| Certificate::from_der(der.as_ref()).to_owned()).collect();
    ensure!(
        !certificates.is_empty(),
        "expected certificates that this system trusts, found none; install the package ca-certificates, or name their \
         file in SSL_CERT_FILE"
    );
    Ok(TlsConfig::builder().root_certs(RootCerts::Specific(Arc::new(certificates))).build())
}

fn failure(error: Error) -> Failure {
    match error {
        Error::Timeout(_) | Error::Io(_) | Error::ConnectionFailed | Error::HostNotFound | Error::Protocol(_) => {
            Failure::Busy(error.to_string(), None)
        }
        error => Failure::Final(anyhow::Error::new(error).context("the server cannot be asked")),
    }
}

/// What another status than 200 means.
fn refusal(status: StatusCode, response: &mut Response<Body>) -> Failure {
    let header = |name: &str| response.headers().get(name).and_then(|value| value.to_str().ok());
    let told = format!("status {status}");
    if status.is_redirection() {
        let target = shown(header("location").unwrap_or("nowhere"));
        return Failure::Final(anyhow!("{told}: the server is now at {target}; name it with --endpoint"));
    }
    let asked = header("retry-after").and_then(|seconds| seconds.trim().parse().ok()).map(Duration::from_secs);
    if matches!(status.as_u16(), 408 | 429 | 500 | 502 | 503 | 504) {
        return Failure::Busy(told, asked);
    }
    let mut text = Vec::new();
    // What it says besides is told as far as it comes.
    let _ = response.body_mut().as_reader().take(QUOTED as u64 * 4).read_to_end(&mut text);
    Failure::Final(anyhow!("{told}: {}", quoted(&text)))
}

/// Whether a reply is a whole OpenStreetMap file.
fn whole(bytes: &[u8]) -> Result<(), Failure> {
    let end = bytes.trim_ascii_end();
    let after = |name: &str| position(bytes, name.as_bytes()).map(|at| &bytes[at + name.len()..]);
    // Overpass tells of faults on its side within a reply that is otherwise whole.
    if let Some(remark) = after("<remark>") {
        let text = quoted(remark.split(|&b| b == b'<').next().unwrap_or_default());
        return Err(if text.contains("open64") || text.contains("Dispatcher") {
            Failure::Busy(text, None)
        } else {
            Failure::Final(anyhow!(
                "expected a whole map, found the remark: {text}; name fewer scenes in drive.scenes, or try again later"
            ))
        });
    }
    if position(&bytes[..bytes.len().min(4096)], b"<osm").is_none() && !bytes.is_empty() {
        return Err(Failure::Final(anyhow!(
            "expected OpenStreetMap XML, found: {}; is it the address of an Overpass API?",
            quoted(bytes)
        )));
    }
    if !end.ends_with(b"</osm>") {
        return Err(Failure::Busy(format!("a reply of {} bytes without </osm> at its end", bytes.len()), None));
    }
    Ok(())
}

/// Where a text begins in another one.
fn position(bytes: &[u8], text: &[u8]) -> Option<usize> {
    bytes.windows(text.len()).position(|window| window == text)
}

/// The beginning of a text from a server.
fn quoted(bytes: &[u8]) -> String {
    let text: String = String::from_utf8_lossy(bytes).chars().take(QUOTED).collect();
    shown(text.trim())
}
