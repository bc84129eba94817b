//! The command `pseudopod`.
fn main() {}
