//! The live page: what a result holds, answered piece by piece to a page in the browser, served or in one file.
//!
//! A [`Scene`] answers requests such as `frame/12` or `values/12/volume` with bytes. [`Server`] hands them to the page over HTTP,
//! on this machine alone; [`page::self_contained`] puts them all into one file. Neither changes a result or a run.

mod charts;
mod describe;
mod film;
mod http;
mod live;
mod pack;
pub mod page;
mod scene;
mod server;

pub use film::Film;
pub use live::{Live, Phase, Told, Watched, Wish};
pub use scene::{Answer, Scene};
pub use server::Server;
