//! The reference pages of the book are those of this version.

use pseudopod::cli::reference::{Page, text};

#[test]
fn the_reference_pages_are_those_of_the_readers() {
    let pages = [
        ("experiment", Page::Experiment),
        ("study", Page::Study),
        ("fit", Page::Fit),
        ("eml", Page::Eml),
        ("commands", Page::Commands),
    ];
    let mut stale = Vec::new();
    for (name, page) in pages {
        let (path, now) = (format!("docs/src/reference_{name}.md"), text(page));
        if std::env::var_os("PSEUDOPOD_BLESS").is_some() {
            std::fs::write(&path, &now).expect("the page can be written");
        } else if std::fs::read_to_string(&path).unwrap_or_default() != now {
            stale.push(format!("pseudopod reference {name} --force -o {path}"));
        }
    }
    assert!(stale.is_empty(), "pages that are not current; run:\n{}", stale.join("\n"));
}
