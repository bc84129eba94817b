//! As much of HTTP/1.1 as the page needs: requests without a body on connections of this machine, each answered once. Whatever a connection
//! sends, it takes a few kilobytes and some seconds of a thread of its own.

use std::io::{ErrorKind, Read, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// The most that a request may take, bytes.
const LONGEST: usize = 16 * 1024;

/// The most headers of a request.
const HEADERS: usize = 64;

/// The longest that a request may take to come, and an answer to be taken.
const PATIENCE: Duration = Duration::from_secs(10);

/// Connections at a time; others are not taken.
const CONNECTIONS: usize = 128;

/// What is asked for.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Asked {
    pub method: String,
    /// With its escapes, without what follows a question mark.
    pub path: String,
    pub host: Option<String>,
    pub origin: Option<String>,
}

/// What a request is answered with.
pub(super) struct Reply {
    pub status: u16,
    pub kind: &'static str,
    pub bytes: Vec<u8>,
}

impl Reply {
    pub fn new(kind: &'static str, bytes: impl Into<Vec<u8>>) -> Self {
        Self { status: 200, kind, bytes: bytes.into() }
    }

    pub fn refused(status: u16, words: &str) -> Self {
        Self { status, kind: "text/plain; charset=utf-8", bytes: format!("{words}\n").into() }
    }

    fn write(&self, to: &mut impl Write, policy: &str) -> std::io::Result<()> {
        let (status, kind, length) = (self.status, self.kind, self.bytes.len());
        let words = match status {
            200 => "OK",
            204 => "No Content",
            400 => "Bad Request",
            403 => "Forbidden",
            404 => "Not Found",
            405 => "Method Not Allowed",
            431 => "Request Header Fields Too Large",
            503 => "Service Unavailable",
            _ => "Internal Server Error",
        };
        write!(
            to,
            "HTTP/1.1 {status} {words}\r\nContent-Type: {kind}\r\nContent-Length: {length}\r\nCache-Control: no-store\r\n\
             Content-Security-Policy: {policy}\r\nX-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\nConnection: close\r\n\r\n"
        )?;
        to.write_all(&self.bytes)?;
        to.flush()
    }
}

/// Who answers.
pub(super) trait Answers: Send + Sync + 'static {
    /// What the page may load.
    const POLICY: &'static str;
    /// The answer to a request; none where the connection is for events, see [`Answers::tell`].
    fn answer(&self, asked: &Asked) -> Option<Reply>;
    /// Tells events for as long as somebody takes them.
    fn tell(&self, to: &mut dyn Write) -> std::io::Result<()>;
}

/// Answers the connections of a listener until `ends`, which is looked at when one comes.
pub(super) fn serve(listener: &TcpListener, ends: &AtomicBool, with: &Arc<impl Answers>) {
    let open = Arc::new(AtomicUsize::new(0));
    for stream in listener.incoming() {
        if ends.load(Ordering::Relaxed) {
            return;
        }
        let Ok(stream) = stream else {
            // No more files for now, say.
            std::thread::sleep(Duration::from_millis(50));
            continue;
        };
        if open.fetch_add(1, Ordering::Relaxed) >= CONNECTIONS {
            open.fetch_sub(1, Ordering::Relaxed);
            continue;
        }
        let (with, here) = (Arc::clone(with), Arc::clone(&open));
        let answer = move || {
            let _ = converse(stream, &*with);
            here.fetch_sub(1, Ordering::Relaxed);
        };
        if std::thread::Builder::new().spawn(answer).is_err() {
            open.fetch_sub(1, Ordering::Relaxed);
        }
    }
}

fn converse<A: Answers>(mut stream: TcpStream, with: &A) -> std::io::Result<()> {
    stream.set_write_timeout(Some(PATIENCE))?;
    stream.set_nodelay(true)?;
    let reply = match read(&mut stream)? {
        Ok(asked) => match with.answer(&asked) {
            Some(reply) => reply,
            None => {
                write!(
                    stream,
                    "HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\nCache-Control: no-store\r\nConnection: close\r\n\r\n"
                )?;
                return with.tell(&mut stream);
            }
        },
        Err(status) => Reply::refused(status, "this is no request that can be answered"),
    };
    reply.write(&mut stream, A::POLICY)?;
    stream.shutdown(Shutdown::Write)
}

/// Reads a request; its status where it cannot be answered.
fn read(stream: &mut (impl Read + Patient)) -> std::io::Result<Result<Asked, u16>> {
    let until = Instant::now() + PATIENCE;
    let mut bytes = Vec::with_capacity(1024);
    loop {
        let left = until.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Err(ErrorKind::TimedOut.into());
        }
        stream.wait_at_most(left)?;
        let mut part = [0; 1024];
        let count = stream.read(&mut part)?;
        if count == 0 {
            return Err(ErrorKind::UnexpectedEof.into());
        }
        bytes.extend_from_slice(&part[..count]);
        match asked(&bytes) {
            Some(found) => return Ok(found),
            None if bytes.len() > LONGEST => return Ok(Err(431)),
            None => {}
        }
    }
}

/// What can be told to wait no longer than so.
trait Patient {
    fn wait_at_most(&self, time: Duration) -> std::io::Result<()>;
}

impl Patient for TcpStream {
    fn wait_at_most(&self, time: Duration) -> std::io::Result<()> {
        self.set_read_timeout(Some(time))
    }
}

/// The request in some bytes; none where more must come.
fn asked(bytes: &[u8]) -> Option<Result<Asked, u16>> {
    let mut headers = [httparse::EMPTY_HEADER; HEADERS];
    let mut request = httparse::Request::new(&mut headers);
    match request.parse(bytes) {
        Ok(httparse::Status::Partial) => None,
        Ok(httparse::Status::Complete(_)) => {
            let header = |name: &str| {
                let found = request.headers.iter().find(|header| header.name.eq_ignore_ascii_case(name));
                found.map(|header| String::from_utf8_lossy(header.value).into_owned())
            };
            let path = request.path.unwrap_or_default().split('?').next().unwrap_or_default().to_owned();
            let method = request.method.unwrap_or_default().to_owned();
            Some(Ok(Asked { method, path, host: header("Host"), origin: header("Origin") }))
        }
        Err(httparse::Error::TooManyHeaders) => Some(Err(431)),
        Err(_) => Some(Err(400)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn requests_are_read_as_they_come() {
        let whole = b"GET /key/data/frame/3?x=1 HTTP/1.1\r\nHost: localhost:80\r\norigin: http://localhost\r\nContent-Length: 99999999999\r\n\r\n";
        for end in 0..whole.len() - 1 {
            assert_eq!(asked(&whole[..end]), None, "{end}");
        }
        let found = asked(whole).unwrap().unwrap();
        assert_eq!((found.method.as_str(), found.path.as_str()), ("GET", "/key/data/frame/3"));
        assert_eq!(found.host.as_deref(), Some("localhost:80"));
        assert_eq!(found.origin.as_deref(), Some("http://localhost"));
        assert_eq!(asked(b"\x16\x03\x01\x02\x00\x01\x00\x01"), Some(Err(400)));
        let many: String = (0..100).map(|k| format!("X-{k}: 1\r\n")).collect();
        assert_eq!(asked(format!("GET / HTTP/1.1\r\n{many}\r\n").as_bytes()), Some(Err(431)));
    }

    /// Bytes that come one by one, for ever.
    struct Drip(usize);

    impl Read for Drip {
        fn read(&mut self, part: &mut [u8]) -> std::io::Result<usize> {
            self.0 += 1;
            part[0] = b'a';
            Ok(1)
        }
    }

    impl Patient for Drip {
        fn wait_at_most(&self, _: Duration) -> std::io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_request_that_does_not_end_is_ended() {
        struct Endless<'a>(&'a [u8], Drip);
        impl Read for Endless<'_> {
            fn read(&mut self, part: &mut [u8]) -> std::io::Result<usize> {
                if self.0.is_empty() { self.1.read(part) } else { self.0.read(part) }
            }
        }
        impl Patient for Endless<'_> {
            fn wait_at_most(&self, _: Duration) -> std::io::Result<()> {
                Ok(())
            }
        }
        let mut endless = Endless(b"GET / HTTP/1.1\r\nX: ", Drip(0));
        assert_eq!(read(&mut endless).unwrap(), Err(431));
        assert!(endless.1.0 <= LONGEST + 1);
    }
}
