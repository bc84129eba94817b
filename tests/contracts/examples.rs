//! The examples of the library run to their ends, and what they assert holds.

#[path = "../../examples/drive_fibre.rs"]
mod drive_fibre;
#[path = "../../examples/positions.rs"]
mod positions;
#[path = "../../examples/stop_rule.rs"]
mod stop_rule;
#[path = "../../examples/sweep.rs"]
mod sweep;

#[test]
fn positions_are_read_as_a_cell_is_pulled() {
    positions::main().unwrap();
}

#[test]
fn a_rule_of_its_own_ends_a_simulation() {
    stop_rule::main().unwrap();
}

#[test]
fn a_sweep_needs_no_file() {
    sweep::main().unwrap();
}

#[test]
fn a_program_drives_a_fibre() {
    drive_fibre::main().unwrap();
}
