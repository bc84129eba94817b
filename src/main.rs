//! The command `pseudopod`.

use clap::Parser;
use pseudopod::cli::{Arguments, main as act, own_fault};

fn main() {
    own_fault::listen();
    std::process::exit(act(Arguments::parse()));
}
