//! The server of a page that shows a solve while it runs. It answers this machine only, and knows four addresses.
//!
//! It listens on the loopback address, so no other machine reaches it. A page from elsewhere that is open in the same browser cannot read
//! the answers (no `Access-Control-Allow-Origin`), and not even under a name of its own that leads here: the `Host` must be
//! this address.

use crate::failure::Failure;
use serde_json::json;
use std::net::Ipv4Addr;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use tiny_http::{Header, Method, Request, Response};

/// Whoever watches asks this often, at least.
const WATCHES: Duration = Duration::from_secs(5);

/// What there is to see.
#[derive(Default)]
pub struct Shown {
    /// The parts of a page as `isolux_io::export::html` makes them; empty until the first draft.
    pub surfaces: Arc<[u8]>,
    pub light: Arc<[u8]>,
    /// Counts the lights.
    pub revision: u64,
    /// Whether this is the end.
    pub finished: bool,
    /// How far it is, for people.
    pub words: String,
    /// When it was asked for last.
    asked: Option<Instant>,
}

/// A server on a thread of its own, until it is dropped.
pub struct Server {
    http: Arc<tiny_http::Server>,
    shown: Arc<Mutex<Shown>>,
    port: u16,
}

/// An answer: status, type, and what it says.
type Answer = (u16, &'static str, Arc<[u8]>);

impl Server {
    /// Serves `page` on `port` of the loopback address; 0 is any that is free.
    ///
    /// # Errors
    /// A failure if the port cannot be had.
    pub fn start(page: Vec<u8>, port: u16) -> Result<Server, Failure> {
        let http = tiny_http::Server::http((Ipv4Addr::LOCALHOST, port)).map_err(|error| {
            Failure::other(format!("cannot serve the page on port {port}: {error}"))
                .with_help("--port takes another one; without it any free port will do")
        })?;
        let port = http.server_addr().to_ip().map_or(port, |address| address.port());
        let server = Server { http: Arc::new(http), shown: Arc::default(), port };
        let (http, shown, page) = (server.http.clone(), server.shown.clone(), Arc::from(page));
        let serve = move || {
            for request in http.incoming_requests() {
                let host = request.headers().iter().find(|header| header.field.equiv("Host"));
                let host = host.map(|header| header.value.to_string());
                let found = answer(&page, &mut lock(&shown), request.method(), request.url(), host.as_deref(), port);
                reply(request, found);
            }
        };
        let spawned = std::thread::Builder::new().name("page".to_owned()).spawn(serve);
        spawned.map_err(|error| Failure::other(format!("cannot serve the page: {error}")))?;
        Ok(server)
    }

    /// Where the page is.
    pub fn address(&self) -> String {
        format!("http://127.0.0.1:{}/", self.port)
    }

    /// What is shown from now on.
    pub fn shown(&self) -> MutexGuard<'_, Shown> {
        lock(&self.shown)
    }

    /// Whether a page is open.
    pub fn is_watched(&self) -> bool {
        self.shown().asked.is_some_and(|asked| asked.elapsed() < WATCHES)
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.http.unblock();
    }
}

fn lock(shown: &Mutex<Shown>) -> MutexGuard<'_, Shown> {
    shown.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What is said to a request; 404 to all that is not meant for this server.
fn answer(page: &Arc<[u8]>, shown: &mut Shown, method: &Method, url: &str, host: Option<&str>, port: u16) -> Answer {
    const BINARY: &str = "application/octet-stream";
    let is_host = |name: &str| host == Some(format!("{name}:{port}").as_str());
    let refused = || (404, "text/plain", Arc::from(&b"there is nothing here\n"[..]));
    if *method != Method::Get || !(is_host("127.0.0.1") || is_host("localhost")) {
        return refused();
    }
    let found = match url {
        "/" => (200, "text/html; charset=utf-8", page.clone()),
        "/surfaces" => (200, BINARY, shown.surfaces.clone()),
        "/light" => (200, BINARY, shown.light.clone()),
        "/revision" => {
            let Shown { revision, finished, words, .. } = &*shown;
            let text = json!({ "revision": revision, "finished": finished, "words": words }).to_string();
            (200, "application/json", Arc::from(text.into_bytes()))
        }
        _ => return refused(),
    };
    shown.asked = Some(Instant::now());
    found
}

fn reply(request: Request, (status, kind, bytes): Answer) {
    let headers = [
        ("Content-Type", kind),
        ("Cache-Control", "no-store"),
        ("X-Content-Type-Options", "nosniff"),
        ("X-Frame-Options", "DENY"),
    ];
    let headers = headers.iter().filter_map(|(name, value)| Header::from_bytes(*name, *value).ok()).collect();
    let length = bytes.len();
    let response = Response::new(status.into(), headers, std::io::Cursor::new(bytes), Some(length), None);
    // Whoever asked may have gone away.
    let _ = request.respond(response);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn status(method: Method, url: &str, host: Option<&str>) -> u16 {
        answer(&Arc::from(&b"page"[..]), &mut Shown::default(), &method, url, host, 80).0
    }

    #[test]
    fn only_this_machine_is_answered_and_only_what_is_shown() {
        let here = Some("127.0.0.1:80");
        for url in ["/", "/surfaces", "/light", "/revision"] {
            assert_eq!((status(Method::Get, url, here), status(Method::Get, url, Some("localhost:80"))), (200, 200));
            for host in
                [None, Some("127.0.0.1"), Some("127.0.0.1:81"), Some("evil.example:80"), Some("localhost:80.evil")]
            {
                assert_eq!(status(Method::Get, url, host), 404, "{host:?}");
            }
            for method in [Method::Post, Method::Put, Method::Head, Method::Options] {
                assert_eq!(status(method, url, here), 404);
            }
        }
        for url in ["/../etc/passwd", "//", "/light/", "/light?x", "/LIGHT", "", "*", "http://127.0.0.1:80/light"] {
            assert_eq!(status(Method::Get, url, here), 404, "{url}");
        }
    }

    #[test]
    fn the_revision_is_told_and_asking_is_noticed() {
        let server = Server::start(b"page".to_vec(), 0).unwrap();
        assert!(!server.is_watched());
        *server.shown() = Shown { revision: 3, words: "\"far\"".to_owned(), ..Shown::default() };
        let host = format!("127.0.0.1:{}", server.port);
        let mut shown = server.shown();
        let (_, _, text) = answer(&Arc::default(), &mut shown, &Method::Get, "/revision", Some(&host), server.port);
        let said: serde_json::Value = serde_json::from_slice(&text).unwrap();
        assert_eq!((&said["revision"], &said["words"]), (&json!(3), &json!("\"far\"")));
        drop(shown);
        assert!(server.is_watched());
    }
}
