//! The page and its data over HTTP: on this machine alone, at an address that nobody guesses.

use std::io::Write;
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant, SystemTime};

use rand::TryRng as _;
use rand::rngs::SysRng;
use serde_json::json;

use super::http::{self, Answers, Asked, Reply};
use super::live::{Live, Phase, Wish};
use super::page;
use super::scene::{Answer, Scene};
use crate::error::{Error, Result};

/// Time between two looks whether something is new.
const LOOK: Duration = Duration::from_millis(250);

/// Serves a result, or a run that goes on, to pages on this machine.
pub struct Server {
    shared: Arc<Shared>,
    address: String,
    socket: SocketAddr,
}

struct Shared {
    /// The first part of all paths.
    key: String,
    path: PathBuf,
    scene: OnceLock<Scene>,
    live: Option<Arc<Live>>,
    /// What was found when the result was looked at last.
    known: Mutex<Option<Known>>,
    /// Pages that are told of changes.
    pages: AtomicUsize,
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
        let cannot = |error: &std::io::Error| Error::Machine {
            message: format!("nothing can be served at port {port} of 127.0.0.1: {error}"),
            help: "name another port with --port, or none for a free one".into(),
        };
        let listener = TcpListener::bind(("127.0.0.1", port)).map_err(|error| cannot(&error))?;
        let socket = listener.local_addr().map_err(|error| cannot(&error))?;
        let key = SysRng.try_next_u64().map_err(|error| Error::Machine {
            message: format!("the system has no random numbers for the address of the page: {error}"),
            help: "write the page into a file instead: pseudopod export --html".into(),
        })?;
        let key = format!("{key:016x}");
        let address = format!("http://{socket}/{key}/");
        let shared = Arc::new(Shared {
            key,
            path: path.to_path_buf(),
            scene,
            live,
            known: Mutex::new(None),
            pages: AtomicUsize::new(0),
            ends: AtomicBool::new(false),
        });
        let serving = Arc::clone(&shared);
        std::thread::spawn(move || http::serve(&listener, &serving.ends, &serving));
        Ok(Self { shared, address, socket })
    }

    /// Where the page is: an address with a key, without which nothing is answered.
    pub fn address(&self) -> &str {
        &self.address
    }

    /// Pages that are open now.
    pub fn pages(&self) -> usize {
        self.shared.pages.load(Ordering::Relaxed)
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.shared.ends.store(true, Ordering::Relaxed);
        // Whoever waits for the next connection looks whether to go on when one comes.
        drop(TcpStream::connect(self.socket));
    }
}

impl Answers for Shared {
    const POLICY: &'static str = "default-src 'self'; img-src 'self' data: blob:; media-src blob:; style-src 'self' 'unsafe-inline'; frame-ancestors 'none'";

    fn answer(&self, asked: &Asked) -> Option<Reply> {
        let below = asked.path.strip_prefix('/').and_then(|path| path.strip_prefix(self.key.as_str()));
        let below = below.and_then(|path| path.strip_prefix('/')).map(decoded);
        Some(match (below.as_deref(), is_from_here(asked)) {
            // A page of another site, whose name was made to mean this machine, is told nothing.
            (_, false) => Reply::refused(403, "this is answered to pages of this machine only"),
            (None, true) => Reply::refused(404, "nothing is here: open the whole address that pseudopod has printed"),
            (Some("events"), true) => return None,
            (Some(below), true) => self.reply(&asked.method, below),
        })
    }

    /// Tells a page what is new for as long as it listens, as server-sent events.
    fn tell(&self, page: &mut dyn Write) -> std::io::Result<()> {
        self.pages.fetch_add(1, Ordering::Relaxed);
        let told = self.tell_to(page);
        self.pages.fetch_sub(1, Ordering::Relaxed);
        told
    }
}

/// Whether a request names this machine, and comes from its own page where it says from which.
fn is_from_here(asked: &Asked) -> bool {
    let is_here = |name: &str| {
        let host = name.rsplit_once(':').map_or(name, |(host, _)| host);
        host == "127.0.0.1" || host.eq_ignore_ascii_case("localhost")
    };
    asked.host.as_deref().is_some_and(is_here)
        && asked.origin.as_deref().is_none_or(|origin| origin.strip_prefix("http://").is_some_and(is_here))
}

impl Shared {
    fn reply(&self, method: &str, below: &str) -> Reply {
        match (method, below) {
            ("GET", "") => Reply::new("text/html; charset=utf-8", page::served()),
            ("GET", "viewer.js") => Reply::new("text/javascript; charset=utf-8", page::SCRIPT),
            ("GET", "style.css") => Reply::new("text/css; charset=utf-8", page::STYLE),
            ("GET", "now") => match self.live.as_ref().and_then(|live| live.picture()) {
                Some((time, picture)) => {
                    let mut bytes = time.to_le_bytes().to_vec();
                    bytes.extend(picture.iter());
                    Reply::new("application/octet-stream", bytes)
                }
                // Nothing to see yet, which is no fault.
                None => Reply { status: 204, kind: "application/octet-stream", bytes: Vec::new() },
            },
            ("POST", wish) => match (&self.live, wish) {
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
            ("GET", below) => below
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

    fn tell_to(&self, page: &mut dyn Write) -> std::io::Result<()> {
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
