//! How claims are read and held.

use super::*;

fn claim(keys: &str) -> String {
    format!("[[claim]]\nmeasure = \"m\"\nsource = \"theory\"\n{keys}\n")
}

fn faults(text: &str) -> Vec<Fault> {
    let Err(Error::Input(faults)) = parse("expected.toml", text) else { panic!("no faults in {text:?}") };
    faults
}

fn lines(keys: &str, found: f64) -> Vec<String> {
    let measure = Measure { name: "m".into(), value: found, unit: "um".into(), description: String::new() };
    let claims = parse("expected.toml", &claim(keys)).unwrap();
    check_claims(&claims, &[measure]).iter().map(|result| format!("{}: {result}", result.verdict())).collect()
}

#[test]
fn each_bound_is_held_and_told() {
    let reason = "\nreason = \"digits printed\"";
    assert_eq!(lines("at_most = 0.049", 0.031), ["holds: m = 0.031 um (at most 0.049)"]);
    assert_eq!(lines("at_most = 0.049", 0.0491), ["fails: m = 0.0491 um (at most 0.049)"]);
    assert_eq!(lines("at_least = 3", 3.0), ["holds: m = 3 um (at least 3)"]);
    assert_eq!(lines("at_least = 1\nat_most = 2", 2.5), ["fails: m = 2.5 um (from 1 to 2)"]);
    let relative = format!("equals = -2.5\nwithin = 0.02{reason}");
    assert_eq!(lines(&relative, -2.549), ["holds: m = -2.549 um (-2.5 within 2 %)"]);
    assert_eq!(lines(&relative, -2.551), ["fails: m = -2.551 um (-2.5 within 2 %)"]);
    let absolute = format!("equals = 6\nwithin_absolute = 0{reason}");
    assert_eq!(lines(&absolute, 6.0), ["holds: m = 6 um (6 within ±0)"]);
    assert_eq!(lines("at_most = 1", f64::NAN), ["fails: m = NaN um (at most 1)"]);
}

#[test]
fn a_measure_that_is_not_there_fails() {
    let results = check_claims(&parse("e", &claim("at_most = 1")).unwrap(), &[]);
    assert!(!results[0].holds());
    assert_eq!(results[0].to_string(), "m is not measured (at most 1)");
}

#[test]
fn faults_point_into_the_document() {
    let text = claim("at_mots = 1");
    let fault = &faults(&text)[0];
    let location = fault.location.as_ref().unwrap();
    assert_eq!(&text[location.start..location.start + location.length], "at_mots");
    assert!(fault.message.contains("unknown field `at_mots`"), "{}", fault.message);
    assert!(faults("[[claim]]\nmeasure = \"m\"\nat_most = 1\n")[0].message.contains("source"));
    assert!(faults("[[claim]\n")[0].location.is_some());
    assert!(faults("")[0].message.contains("claims nothing"));
}

#[test]
fn every_claim_needs_one_bound_and_tolerances_a_reason() {
    let wrong = ["", "at_most = 1\nat_least = 2", "equals = 1\nwithin = 0.1\nat_most = 2"];
    let text: String = wrong.iter().map(|keys| claim(keys)).collect();
    let faults = faults(&text);
    assert_eq!(faults.len(), wrong.len());
    assert!(faults.iter().all(|fault| fault.message.contains("no single bound") && fault.location.is_some()));
    assert!(self::faults(&claim("equals = 1"))[0].message.contains("without a tolerance"));
    assert!(self::faults(&claim("equals = 1\nwithin = 0.1"))[0].message.contains("without a reason"));
    assert!(self::faults(&claim("at_most = nan"))[0].message.contains("not finite"));
}
