//! A workflow for Snakemake that makes the runs of a plan, each by itself, and collects them.

use super::paths::refused;
use super::plan::Plan;
use crate::error::Result;
use std::path::PathBuf;

/// The workflow; the program can be another one, by `--config pseudopod=PATH`.
const SNAKEFILE: &str = r#"# Written by pseudopod: the runs of this study, for Snakemake.
#
#   snakemake --cores 8 --keep-going
#
# makes all results that are not there, each by itself, and collects them. On a cluster several runs go together into a job:
#
#   snakemake --executor slurm --jobs 50 --group-components runs=20 --keep-going
#
# A run that was stopped goes on from its checkpoint.

PSEUDOPOD = config.get("pseudopod", "pseudopod")
RUNS = [f"{run:05d}" for run in range(1, COUNT + 1)]


# All results are asked for, not the tables alone: so one that was lost is made again.
rule all:
    input:
        expand("runs/{run}.vtkhdf", run=RUNS),
        OUTPUTS


rule collect:
    input:
        "runs.csv",
        expand("runs/{run}.vtkhdf", run=RUNS),
    output:
        OUTPUTS
    shell:
        "{PSEUDOPOD} sweep collect ."


rule run:
    input:
        "runs.csv",
        "plan.json",
    output:
        "runs/{run}.vtkhdf",
    log:
        "logs/{run}.log",
    group:
        "runs"
    threads: 1
    shell:
        "{PSEUDOPOD} run --plan runs.csv --row {wildcards.run} --skip-complete --quiet --no-pictures"
        " --threads {threads} > {log} 2>&1"
"#;

/// Writes the workflow of a plan beside it; one that is there is replaced.
///
/// # Errors
/// [`Machine`](crate::error::Error::Machine) when the disk refuses.
pub fn write(plan: &Plan) -> Result<PathBuf> {
    let path = plan.folder.join("Snakefile");
    let outputs =
        if cfg!(feature = "parquet") { "\"summary.csv\",\n        \"summary.parquet\"," } else { "\"summary.csv\"," };
    let text = SNAKEFILE.replace("COUNT", &plan.runs.len().to_string()).replace("OUTPUTS", outputs);
    std::fs::write(&path, text).map_err(|error| refused(&path, &error))?;
    Ok(path)
}
