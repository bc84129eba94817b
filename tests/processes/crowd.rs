//! Cells that are so soft that they fold where they stick are apart in every frame, and the run comes to its end.

use std::process::Command;

use crate::turns::take_turn;

/// Three hundred cells that bear twice the work that it takes to part them: `check` says that they may fold.
const CROWD: &str = r#"
title = "A crowd is drawn together"
[run]
until = "60 s"
[cells.cell]
number = 300
mesh = { shape = "icosphere", radius = "5 um", level = 1 }
placement = { random_from = ["-50 um", "-50 um", "-50 um"], random_to = ["50 um", "50 um", "50 um"] }
[cells.cell.mechanics]
drag = "20 pN s/um"
shape_memory = { stiffness = "1 pN/um" }
[cells.cell.motility]
brownian = { speed = "3 um/min", persistence = "20 s", space = "volume" }
attraction = { to = ["0 um", "0 um", "0 um"], stiffness = "0.01 pN/um" }
[contact]
strength = "0.2 pN/um^2"
[output]
every = "4 s"
"#;

#[test]
#[ignore = "slow: 3 to 5 minutes"]
fn three_hundred_soft_cells_that_fold_are_apart_in_every_frame() {
    let _turn = take_turn();
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("crowd.toml"), CROWD).unwrap();
    let program = env!("CARGO_BIN_EXE_pseudopod");
    let run = Command::new(program)
        .args(["run", "crowd.toml", "-o", "crowd.vtkhdf", "--no-pictures"])
        .current_dir(folder.path())
        .output()
        .unwrap();
    // Before a frame is recorded all atoms and edges are looked at: cells deeper in each other than is promised end the run with exit 3.
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    println!("{}", String::from_utf8_lossy(&run.stdout));
}
