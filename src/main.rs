//! The command `pseudopod`.

use clap::Parser;
use pseudopod::cli::{Arguments, main as act};

fn main() {
    std::process::exit(act(Arguments::parse()));
}
