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
    let measures = BTreeMap::from([("m".to_owned(), found)]);
    let claims = parse("expected.toml", &claim(keys)).unwrap();
    check_claims(&claims, &measures).iter().map(ToString::to_string).collect()
}

#[test]
fn each_bound_is_held_and_printed() {
    let reason = "\nreason = \"digits printed\"";
    assert_eq!(lines("at_most = 0.049", 0.031), ["ok      m = 0.031 (at most 0.049; theory)"]);
    assert_eq!(lines("at_most = 0.049", 0.0491), ["FAILED  m = 0.0491 (at most 0.049; theory)"]);
    assert_eq!(lines("at_least = 3", 3.0), ["ok      m = 3 (at least 3; theory)"]);
    assert_eq!(lines("at_least = 1\nat_most = 2", 2.5), ["FAILED  m = 2.5 (from 1 to 2; theory)"]);
    let relative = format!("equals = -2.5\nwithin = 0.02{reason}");
    assert_eq!(lines(&relative, -2.549), ["ok      m = -2.549 (-2.5 within 2 %; theory)"]);
    assert_eq!(lines(&relative, -2.551), ["FAILED  m = -2.551 (-2.5 within 2 %; theory)"]);
    let absolute = format!("equals = 6\nwithin_absolute = 0{reason}");
    assert_eq!(lines(&absolute, 6.0), ["ok      m = 6 (6 within ±0; theory)"]);
    assert_eq!(lines("at_most = 1", f64::NAN), ["FAILED  m = NaN (at most 1; theory)"]);
}

#[test]
fn a_measure_that_is_not_there_fails() {
    let results = check_claims(&parse("e", &claim("at_most = 1")).unwrap(), &BTreeMap::new());
    assert!(!results[0].holds());
    assert_eq!(results[0].to_string(), "FAILED  m is not measured by this experiment (at most 1; theory)");
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
    let wrong = ["", "equals = 1", "at_most = 1\nat_least = 2", "equals = 1\nwithin = 0.1\nat_most = 2"];
    let text: String = wrong.iter().map(|keys| claim(keys)).collect();
    let faults = faults(&text);
    assert_eq!(faults.len(), wrong.len());
    assert!(faults.iter().all(|fault| fault.message.contains("no single bound") && fault.location.is_some()));
    assert!(self::faults(&claim("equals = 1\nwithin = 0.1"))[0].message.contains("without a reason"));
    assert!(self::faults(&claim("at_most = nan"))[0].message.contains("not finite"));
}
