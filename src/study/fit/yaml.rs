//! The part of YAML that problems of PEtab are written in: keys with texts, lists and tables of them by indentation. Anything else is
//! taken for a text.

/// What a text of YAML says.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Yaml {
    /// A text, a number or nothing.
    Text(String),
    /// Keys with what they say, in order.
    Table(Vec<(String, Yaml)>),
    /// A list.
    List(Vec<Yaml>),
}

impl Yaml {
    /// What a key says, if there is such a key.
    pub fn get(&self, key: &str) -> Option<&Self> {
        self.entries().iter().find(|(known, _)| known == key).map(|(_, value)| value)
    }

    /// Its keys with what they say.
    pub fn entries(&self) -> &[(String, Self)] {
        match self {
            Self::Table(entries) => entries,
            _ => &[],
        }
    }

    /// The text; empty for a table or a list.
    pub fn text(&self) -> String {
        match self {
            Self::Text(text) => text.clone(),
            _ => String::new(),
        }
    }

    /// The texts of a list, or the only one.
    pub fn texts(&self) -> Vec<String> {
        match self {
            Self::Text(text) if text.is_empty() => Vec::new(),
            Self::Text(text) => vec![text.clone()],
            Self::List(items) => items.iter().map(Self::text).collect(),
            Self::Table(_) => Vec::new(),
        }
    }
}

/// Reads a text.
pub fn parse(text: &str) -> Yaml {
    let lines: Vec<(usize, &str)> = text
        .lines()
        .map(without_comment)
        .filter(|line| !line.trim().is_empty() && line.trim() != "---")
        .map(|line| (line.len() - line.trim_start().len(), line.trim()))
        .collect();
    block(&lines)
}

fn without_comment(line: &str) -> &str {
    let starts = line.char_indices().find(|(at, sign)| *sign == '#' && (*at == 0 || line[..*at].ends_with(' ')));
    starts.map_or(line, |(at, _)| &line[..at])
}

/// Lines that belong together: a list, a table or a text.
fn block(lines: &[(usize, &str)]) -> Yaml {
    let Some(&(indent, first)) = lines.first() else { return Yaml::Text(String::new()) };
    let is_item = |line: &str| line == "-" || line.starts_with("- ");
    if !is_item(first) && key_of(first).is_none() {
        return scalar(first);
    }
    // An entry is a line at the indentation of the first, with those that are deeper; items of a list may stand as far out as its key.
    let mut starts: Vec<usize> =
        (0..lines.len()).filter(|k| lines[*k].0 <= indent && (is_item(first) || !is_item(lines[*k].1))).collect();
    starts.push(lines.len());
    let entries = starts.windows(2).map(|ends| &lines[ends[0]..ends[1]]);
    if is_item(first) {
        return Yaml::List(entries.map(|entry| scalar(entry[0].1[1..].trim())).collect());
    }
    let entry = |entry: &[(usize, &str)]| {
        let (key, value) = key_of(entry[0].1)?;
        let said = if value.is_empty() { block(&entry[1..]) } else { scalar(value) };
        Some((unquoted(key), said))
    };
    Yaml::Table(entries.filter_map(entry).collect())
}

/// A key and what follows it.
fn key_of(line: &str) -> Option<(&str, &str)> {
    let at = line.find(": ").or_else(|| line.ends_with(':').then(|| line.len() - 1))?;
    Some((line[..at].trim(), line[at + 1..].trim()))
}

/// A text with or without quotes, or a list in brackets.
fn scalar(text: &str) -> Yaml {
    match text.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')) {
        Some(inside) => Yaml::List(
            inside
                .split(',')
                .map(str::trim)
                .filter(|item| !item.is_empty())
                .map(|item| Yaml::Text(unquoted(item)))
                .collect(),
        ),
        None => Yaml::Text(unquoted(text)),
    }
}

fn unquoted(text: &str) -> String {
    let within = |quote: char| text.strip_prefix(quote).and_then(|rest| rest.strip_suffix(quote));
    within('"').or_else(|| within('\'')).unwrap_or(text).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_problem_of_petab_is_read_however_it_is_laid_out() {
        let blocks = "# a problem\nformat_version: 2.0.0\nparameter_files:\n  - parameters.tsv\nmodel_files:\n  cell:\n    location: \"a b.toml\" # of ours\n    language: pseudopod\nmeasurement_files:\n- one.tsv\n- 'two.tsv'\n";
        let flow = "format_version: \"2.0.0\"\nmodel_files:\n    cell:\n        location: a b.toml\n        language: pseudopod\nparameter_files: [parameters.tsv]\nmeasurement_files: [one.tsv, 'two.tsv']\n";
        for text in [blocks, flow] {
            let yaml = parse(text);
            assert_eq!(yaml.get("format_version").unwrap().text(), "2.0.0");
            assert_eq!(yaml.get("parameter_files").unwrap().texts(), ["parameters.tsv"]);
            assert_eq!(yaml.get("measurement_files").unwrap().texts(), ["one.tsv", "two.tsv"]);
            let model = &yaml.get("model_files").unwrap().entries()[0];
            assert_eq!((model.0.as_str(), model.1.get("location").unwrap().text()), ("cell", "a b.toml".to_owned()));
            assert_eq!(model.1.get("language").unwrap().text(), "pseudopod");
        }
    }

    #[test]
    fn what_is_no_problem_is_a_text_without_keys() {
        for text in ["", "hello", "- a\n- b: c", ":", "[", "a:\n b\n  c: d"] {
            assert!(parse(text).get("format_version").is_none(), "{text}");
        }
    }
}
