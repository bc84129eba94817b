//! The page itself: served with its parts beside it, or in one file with all data in it.

use super::film::Film;

/// The script of the page: three.js and ours, built from `viewer/src` by `viewer/build`.
pub(super) const SCRIPT: &str = include_str!("../../viewer/dist/viewer.js");
pub(super) const STYLE: &str = include_str!("../../viewer/style.css");
const PAGE: &str = include_str!("../../viewer/page.html");

/// Where style, data and script go.
const MARKS: [&str; 3] = ["<!-- style -->", "<!-- data -->", "<!-- script -->"];

/// What a page from the disk may load: nothing but what is in it.
const POLICY: &str =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; media-src blob:";

fn filled(parts: [&str; 3]) -> String {
    let mut page = PAGE.to_owned();
    for (mark, part) in MARKS.iter().zip(parts) {
        page = page.replacen(mark, part, 1);
    }
    page
}

/// The page that loads its parts from where it came from.
pub fn served() -> String {
    filled(["<link rel=\"stylesheet\" href=\"style.css\">", "", "<script type=\"module\" src=\"viewer.js\"></script>"])
}

/// The page with everything in it, to mail and to open from the disk.
pub fn self_contained(film: &Film) -> String {
    let style = format!("<meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">\n<style>\n{STYLE}</style>");
    let data = format!("<script type=\"text/plain\" id=\"film\">{}</script>", film.to_base64());
    // The end of the element must not stand in the script.
    let script = format!("<script type=\"module\">\n{}\n</script>", SCRIPT.replace("</script", "<\\/script"));
    filled([&style, &data, &script])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_has_its_parts_once() {
        for mark in MARKS {
            assert_eq!(PAGE.matches(mark).count(), 1, "{mark}");
        }
        let page = self_contained(&Film::default());
        assert_eq!(page.matches("</script>").count(), 2, "data and script, and no end within them");
        assert!(!page.contains("src=\"http") && !page.contains("href=\"http"));
    }
}
