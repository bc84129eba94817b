//! The page and its data over HTTP: on this machine alone, at an address that nobody guesses.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant, SystemTime};

use rand::TryRng as _;
use rand::rngs::SysRng;
use serde_json::json;
use tiny_http::{Header, Method, Request, Response, StatusCode};

use super::live::{Live, Phase, Wish};
use super::page;
use super::scene::{Answer, Scene};
use crate::error::{Error, Result};

/// Threads that answer.
const THREADS: usize = 4;

/// Time between two looks whether something is new.
const LOOK: Duration = Duration::from_millis(250);

/// What the page may load: itself, and nothing from elsewhere.
const POLICY: &str = "default-src 'self'; img-src 'self' data: blob:; media-src blob:; style-src 'self' 'unsafe-inline'; frame-ancestors 'none'";

/// Serves a result, or a run that goes on, to pages on this machine.
pub struct Server {
    shared: Arc<Shared>,
    address: String,
}

struct Shared {
    http: tiny_http::Server,
    /// The first part of all paths.
    key: String,
    path: PathBuf,
    scene: OnceLock<Scene>,
    live: Option<Arc<Live>>,
    /// What was found when the result was looked at last.
    known: Mutex<Option<Known>>,
    /// Pages that are told of changes.
    pages: AtomicUsize,
    was_watched: AtomicBool,
    ends: AtomicBool,
}

/// A result as it was looked at last.
#[derive(Clone, Copy)]
struct Known {
    frames: usize,
    /// Whether more may come.
    running: bool,
    /// When the file was made, and its length: a version that is newer has others.
    version: Option<(SystemTime, u64)>,
    /// When it may be looked at again.
    next: Instant,
}

/// A look is followed by so many times what it took without one: a run that is watched gives up little of its time.
const SPARED: u32 = 100;

impl Server {
    /// Serves a result at a port, a free one when it is 0, until it is dropped. With a run that goes on, the result need not be there yet.
    ///
    /// # Errors
    /// As [`Scene::open`] where there is no run; [`Error::Machine`] for a port that is taken.
    pub fn start(path: &Path, port: u16, live: Option<Arc<Live>>) -> Result<Self> {
        let scene = OnceLock::new();
        if live.is_none() {
            let _ = scene.set(Scene::open(path)?);
        }
        let http = tiny_http::Server::http(("127.0.0.1", port)).map_err(|error| Error::Machine {
            message: format!("nothing can be served at port {port} of 127.0.0.1: {error}"),
            help: "name another port with --port, or none for a free one".into(),
        })?;
        let port = http.server_addr().to_ip().map_or(port, |address| address.port());
        let key = SysRng.try_next_u64().map_err(|error| Error::Machine {
            message: format!("the system has no random numbers for the address of the page: {error}"),
            help: "write the page into a file instead: pseudopod export --html".into(),
        })?;
        let key = format!("{key:016x}");
        let address = format!("http://127.0.0.1:{port}/{key}/");
        let shared = Arc::new(Shared {
            http,
            key,
            path: path.to_path_buf(),
            scene,
            live,
            known: Mutex::new(None),
            pages: AtomicUsize::new(0),
            was_watched: AtomicBool::new(false),
            ends: AtomicBool::new(false),
        });
        for _ in 0..THREADS {
            let shared = Arc::clone(&shared);
            std::thread::spawn(move || {
                while !shared.ends.load(Ordering::Relaxed) {
                    match shared.http.recv_timeout(LOOK) {
                        Ok(Some(request)) => shared.answer(request),
                        Ok(None) => {}
                        Err(_) => std::thread::sleep(LOOK),
                    }
                }
            });
        }
        Ok(Self { shared, address })
    }

    /// Where the page is: an address with a key, without which nothing is answered.
    pub fn address(&self) -> &str {
        &self.address
    }

    /// Pages that are open now.
    pub fn pages(&self) -> usize {
        self.shared.pages.load(Ordering::Relaxed)
    }

    /// Whether a page was ever open.
    pub fn was_watched(&self) -> bool {
        self.shared.was_watched.load(Ordering::Relaxed)
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.shared.ends.store(true, Ordering::Relaxed);
        self.shared.http.unblock();
    }
}

fn header(name: &str, value: &str) -> Header {
    Header::from_bytes(name, value).expect("headers are plain text")
}

/// What a request is answered with.
struct Reply {
    status: u16,
    kind: &'static str,
    bytes: Vec<u8>,
}

impl Reply {
    fn new(kind: &'static str, bytes: impl Into<Vec<u8>>) -> Self {
        Self { status: 200, kind, bytes: bytes.into() }
    }

    fn refused(status: u16, words: &str) -> Self {
        Self { status, kind: "text/plain; charset=utf-8", bytes: format!("{words}\n").into() }
    }
}

impl Shared {
    fn answer(self: &Arc<Self>, request: Request) {
        let path = request.url().split('?').next().unwrap_or_default().to_owned();
        let below = path.strip_prefix('/').and_then(|path| path.strip_prefix(self.key.as_str()));
        let below = below.and_then(|path| path.strip_prefix('/')).map(decoded);
        let reply = match (below.as_deref(), self.is_from_here(&request)) {
            // A page of another site, whose name was made to mean this machine, is told nothing.
            (_, false) => Reply::refused(403, "this is answered to pages of this machine only"),
            (None, true) => Reply::refused(404, "nothing is here: open the whole address that pseudopod has printed"),
            (Some("events"), true) => return self.tell(request),
            (Some(below), true) => self.reply(request.method(), below),
        };
        let length = Some(reply.bytes.len());
        let headers = [
            ("Content-Type", reply.kind),
            ("Cache-Control", "no-store"),
            ("Content-Security-Policy", POLICY),
            ("X-Content-Type-Options", "nosniff"),
            ("Referrer-Policy", "no-referrer"),
        ];
        let headers = headers.map(|(name, value)| header(name, value)).to_vec();
        let response = Response::new(StatusCode(reply.status), headers, &reply.bytes[..], length, None);
        // A page that is gone needs no answer.
        let _ = request.respond(response);
    }

    /// Whether a request names this machine, and comes from its own page where it says from which.
    fn is_from_here(&self, request: &Request) -> bool {
        let header = |name: &str| {
            let found =
                request.headers().iter().find(|header| header.field.as_str().as_str().eq_ignore_ascii_case(name));
            found.map(|header| header.value.as_str().to_owned())
        };
        let is_here = |name: &str| {
            let host = name.rsplit_once(':').map_or(name, |(host, _)| host);
            host == "127.0.0.1" || host.eq_ignore_ascii_case("localhost")
        };
        let origin = header("Origin");
        header("Host").is_some_and(|host| is_here(&host))
            && origin.is_none_or(|origin| origin.strip_prefix("http://").is_some_and(is_here))
    }

    fn reply(&self, method: &Method, below: &str) -> Reply {
        match (method, below) {
            (Method::Get, "") => Reply::new("text/html; charset=utf-8", page::served()),
            (Method::Get, "viewer.js") => Reply::new("text/javascript; charset=utf-8", page::SCRIPT),
            (Method::Get, "style.css") => Reply::new("text/css; charset=utf-8", page::STYLE),
            (Method::Get, "now") => match self.live.as_ref().and_then(|live| live.picture()) {
                Some((time, picture)) => {
                    let mut bytes = time.to_le_bytes().to_vec();
                    bytes.extend(picture.iter());
                    Reply::new("application/octet-stream", bytes)
                }
                // Nothing to see yet, which is no fault.
                None => Reply { status: 204, kind: "application/octet-stream", bytes: Vec::new() },
            },
            (Method::Post, wish) => match (&self.live, wish) {
                (Some(live), "go" | "pause" | "stop") => {
                    live.want(match wish {
                        "go" => Wish::Go,
                        "pause" => Wish::Pause,
                        _ => Wish::Stop,
                    });
                    Reply::new("application/json", "{}")
                }
                _ => Reply::refused(404, "no run goes on here"),
            },
            (Method::Get, below) => below
                .strip_prefix("data/")
                .map_or_else(|| Reply::refused(404, "nothing is here"), |request| self.data(request)),
            _ => Reply::refused(405, "this is neither asked for nor told so"),
        }
    }

    fn data(&self, request: &str) -> Reply {
        let Some(scene) = self.scene.get() else { return Reply::refused(503, "the run has not recorded a frame yet") };
        match scene.answer(request) {
            Ok(Some(Answer::Text(text))) => Reply::new("application/json", text),
            Ok(Some(Answer::Bytes(bytes))) => Reply::new("application/octet-stream", bytes),
            Ok(None) => Reply::refused(404, &format!("the result has no {request}")),
            Err(error) => Reply::refused(500, &error.to_string()),
        }
    }

    /// Tells a page what is new for as long as it listens, as server-sent events.
    fn tell(self: &Arc<Self>, request: Request) {
        let shared = Arc::clone(self);
        self.pages.fetch_add(1, Ordering::Relaxed);
        self.was_watched.store(true, Ordering::Relaxed);
        std::thread::spawn(move || {
            let mut page = request.into_writer();
            let _ = shared.tell_to(&mut *page);
            shared.pages.fetch_sub(1, Ordering::Relaxed);
        });
    }

    fn tell_to(&self, page: &mut dyn Write) -> std::io::Result<()> {
        write!(
            page,
            "HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\nCache-Control: no-store\r\nConnection: close\r\n\r\n"
        )?;
        let (mut last, mut quiet) = (String::new(), Instant::now());
        while !self.ends.load(Ordering::Relaxed) {
            let news = self.news();
            if news != last {
                write!(page, "data: {news}\n\n")?;
                page.flush()?;
                (last, quiet) = (news, Instant::now());
            } else if quiet.elapsed() > Duration::from_secs(2) {
                // Only a page that is still there takes this.
                write!(page, ": still here\n\n")?;
                page.flush()?;
                quiet = Instant::now();
            }
            std::thread::sleep(LOOK);
        }
        Ok(())
    }

    /// What there is now, as one line of JSON.
    fn news(&self) -> String {
        let (frames, running) = self.look();
        let told = self.live.as_ref().map(|live| live.told());
        let run = told.map(|told| {
            json!({ "phase": told.phase.word(), "time": told.time, "until": told.until, "steps": told.steps, "picture": told.picture, "words": told.words })
        });
        json!({ "frames": frames, "running": running, "run": run }).to_string()
    }

    /// Frames that there are, and whether more may come. A result that grows is looked at again once there is a newer version of it, at most once a
    /// second.
    fn look(&self) -> (usize, bool) {
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let ended = self.live.as_ref().is_some_and(|live| live.told().phase == Phase::Ended);
        let version = std::fs::metadata(&self.path).ok().and_then(|data| Some((data.modified().ok()?, data.len())));
        match *known {
            Some(Known { frames, running: false, .. }) => return (frames, false),
            Some(Known { frames, running: true, next, .. }) if Instant::now() < next && !ended => {
                return (frames, true);
            }
            Some(Known { frames, running: true, version: before, .. })
                if before == version && !ended && self.live.is_some() =>
            {
                return (frames, true);
            }
            _ => {}
        }
        let began = Instant::now();
        let mut found = match self.scene.get() {
            Some(scene) => scene.renew().ok(),
            None => Scene::open(&self.path).ok().map(|scene| {
                let found = scene.with_result(|result| (result.frames(), result.ending().running));
                let _ = self.scene.set(scene);
                found
            }),
        };
        if let (Some(_), Some((_, running))) = (&self.live, &mut found) {
            // The lock of the log may be free for a moment while the run goes on.
            *running = !ended;
        }
        let (frames, running) = found.unwrap_or((0, true));
        // Nothing to open is found out at once.
        let pause = if found.is_some() { Duration::from_secs(1).max(SPARED * began.elapsed()) } else { LOOK };
        let version = version.filter(|_| found.is_some());
        *known = Some(Known { frames, running, version, next: Instant::now() + pause });
        (frames, running)
    }
}

/// A path without its escapes, `%2E` and its like; what is none stays.
fn decoded(path: &str) -> String {
    let mut bytes = Vec::with_capacity(path.len());
    let mut rest = path.as_bytes();
    while let [first, others @ ..] = rest {
        let escaped = (*first == b'%').then(|| others.get(..2)).flatten();
        let escaped = escaped.and_then(|digits| std::str::from_utf8(digits).ok());
        match escaped.and_then(|digits| u8::from_str_radix(digits, 16).ok()) {
            Some(byte) => {
                bytes.push(byte);
                rest = &others[2..];
            }
            None => {
                bytes.push(*first);
                rest = others;
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

#[cfg(test)]
mod tests {
    use super::decoded;

    #[test]
    fn paths_are_read_without_their_escapes() {
        assert_eq!(decoded("data/values/3/a%2Fb%20c"), "data/values/3/a/b c");
        assert_eq!(decoded("%zz%4"), "%zz%4");
        assert_eq!(decoded("%C2%B5m"), "µm");
    }
}
