//! `pseudopod demo`: the experiments that ship, listed, or one of them copied and run.

use super::how::How;
use super::report::{Report, path_text};
use super::run::{self, RunArgs};
use super::shipped::{Shipped, about, experiments, seconds};
use crate::error::{Error, Fault, Result, say};
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Lists the experiments that ship, or copies one into a folder and runs it.
#[derive(Debug, Clone, clap::Args)]
pub struct DemoArgs {
    /// The experiment, or another document of it, as in aggregation/stirred; all are listed when absent.
    pub name: Option<String>,
    /// The folder to copy it to; one of its name in the working folder when absent.
    #[arg(short, long, value_name = "FOLDER", requires = "name")]
    pub output: Option<PathBuf>,
    /// Copies and does not run.
    #[arg(long, requires = "name")]
    pub copy_only: bool,
    /// How it is run.
    #[command(flatten)]
    pub how: How,
}

/// Runs the command.
///
/// # Errors
/// There is no such experiment, the folder exists or cannot be written; and as [`run::run`].
pub fn run(args: &DemoArgs) -> Result<Report> {
    let all = experiments();
    let Some(name) = &args.name else { return Ok(list(&all)) };
    let (experiment, document) = find(&all, name)?;
    let folder = args.output.clone().unwrap_or_else(|| PathBuf::from(experiment.folder));
    copy(experiment, &folder)?;
    let path = folder.join(document);
    if args.copy_only {
        let words = match args.how.quiet {
            true => String::new(),
            false => format!("{}\n", path.display()),
        };
        return Ok(Report { words, ..Report::default() }.fact("document", path_text(&path)));
    }
    if !args.how.quiet {
        let takes =
            seconds(experiment.folder, document).map(|seconds| format!(", which takes about {}", about(seconds)));
        say(&format!("copied to {}; running {}{}", folder.display(), path.display(), takes.unwrap_or_default()));
    }
    let mut report = run::run(&args_of_run(&path, args))?;
    if !args.how.quiet {
        // Writing to a text cannot fail.
        let _ = writeln!(report.words, "change {} and run it again: pseudopod run {0} --force", path.display());
    }
    Ok(report.fact("document", path_text(&path)))
}

/// A run of the copy as anybody would make it, but for the result, which lies beside the document.
fn args_of_run(document: &Path, args: &DemoArgs) -> RunArgs {
    RunArgs {
        experiment: Some(document.to_path_buf()),
        plan: None,
        row: None,
        skip_complete: false,
        output: Some(document.with_extension("vtkhdf")),
        sets: Vec::new(),
        seed: None,
        until: None,
        memory: None,
        force: false,
        how: args.how.clone(),
    }
}

/// The experiment and the document that a name stands for.
fn find<'a>(all: &'a [Shipped], name: &str) -> Result<(&'a Shipped, &'static str)> {
    let name = name.trim_end_matches('/');
    let (folder, document) = name.split_once('/').map_or((name, None), |(folder, rest)| (folder, Some(rest)));
    let Some(experiment) = all.iter().find(|experiment| experiment.folder == folder) else {
        let fault = Fault::new(format!("no experiment that ships is named `{folder}`"));
        let help = match crate::error::words::meant(folder, all.iter().map(|experiment| experiment.folder)) {
            Some(near) => format!("did you mean `{near}`? pseudopod demo lists all"),
            None => "pseudopod demo lists all".to_owned(),
        };
        return Err(Error::input(fault.help(help)));
    };
    let Some(document) = document else { return Ok((experiment, experiment.main)) };
    let found = experiment.document(document.trim_end_matches(".toml"));
    found.map(|found| (experiment, found)).ok_or_else(|| {
        let fault = Fault::new(format!("the experiment `{folder}` has no document `{document}`"));
        let names: Vec<&str> = std::iter::once(experiment.main).chain(experiment.others.iter().copied()).collect();
        Error::input(fault.help(format!("there are: {}", names.join(", "))))
    })
}

/// Writes the files of an experiment into a new folder.
///
/// # Errors
/// The folder holds something, or cannot be written.
pub fn copy(experiment: &Shipped, folder: &Path) -> Result<()> {
    let is_empty = || folder.read_dir().is_ok_and(|mut entries| entries.next().is_none());
    if folder.exists() && !is_empty() {
        let fault = Fault::new(format!("{} exists", folder.display()));
        return Err(Error::input(fault.help("name a new folder with -o, or move that one away")));
    }
    for (name, bytes) in experiment.files() {
        let path = folder.join(name);
        let made = path.parent().map_or(Ok(()), std::fs::create_dir_all).and_then(|()| std::fs::write(&path, bytes));
        made.map_err(|error| Error::Machine {
            message: format!("{} could not be written: {error}", path.display()),
            help: "name a folder that you may write to with -o".into(),
        })?;
    }
    Ok(())
}

/// A line for each experiment; what it shows is told to scripts, and by its document.
fn list(all: &[Shipped]) -> Report {
    let width = all.iter().map(|experiment| experiment.folder.len()).max().unwrap_or(0);
    let mut words = String::new();
    for experiment in all {
        let Shipped { folder, title, seconds, .. } = experiment;
        let takes = seconds.map(about).unwrap_or_default();
        // Writing to a text cannot fail.
        let _ = writeln!(words, "{folder:width$}  {takes:>6}  {title}");
    }
    words.push_str("\npseudopod demo NAME copies one into the folder NAME and runs it; times are of one core\n");
    Report { words, ..Report::default() }.fact("experiments", all.iter().map(object).collect::<Vec<_>>())
}

/// An experiment for scripts.
fn object(experiment: &Shipped) -> Value {
    let Shipped { folder, main, others, title, description, seconds } = experiment;
    json!({
        "name": folder, "title": title, "description": description, "seconds": seconds, "document": main,
        "other_documents": others,
    })
}
