//! `bidir check` as a user meets it.

use std::{
    path::{Path, PathBuf},
    process::{Command, Output},
};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// A surface with mistakes to choose from; `tests/check` says which.
fn wrong() -> String {
    root().join("tests/wrong/wrong.wasm").display().to_string()
}

fn check(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_bidir")).arg("check").args(arguments).output().expect("the program")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn json(output: &Output) -> serde_json::Value {
    serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("no JSON: {}", text(&output.stderr)))
}

/// Bad input: status 1, one line that says what to do.
fn refuses(arguments: &[&str], words: &[&str]) {
    let output = check(arguments);
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{arguments:?}: {said}");
    assert!(said.lines().count() == 1 && said.starts_with("error: ") && said.contains("; ") && output.stdout.is_empty(), "{said}");
    for word in words {
        assert!(said.contains(word), "{arguments:?}: \"{word}\" is not in: {said}");
    }
}

#[test]
fn a_built_in_by_its_name_is_right() {
    let output = check(&["diffuse"]);
    let said = text(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(said.ends_with("all right\n") && said.contains("pass  weight"), "{said}");
    assert!(output.stderr.is_empty(), "{}", text(&output.stderr));
}

#[test]
fn a_light_in_a_folder_of_plugins_is_right_and_says_so_as_json() {
    let folder = root().join("plugins/prebuilt").display().to_string();
    let output = check(&["gobo", "--plugins", &folder, "--json", "--seed", "3"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let report = json(&output);
    assert_eq!((&report["kind"], &report["passed"], &report["seed"]), (&"light".into(), &true.into(), &3.into()));
    let tests: Vec<_> = report["verdicts"].as_array().expect("verdicts").iter().map(|verdict| verdict["test"].as_str()).collect();
    assert_eq!(tests, ["calls", "range", "purity", "agreement", "mass", "sampling", "emission", "power"].map(Some));
    assert!(report["cost"]["eval_nanoseconds"].as_f64().expect("a number") > 0.0 && report["cost"]["memory_bytes"].is_u64());
}

#[test]
fn a_mistake_has_status_3_a_sentence_and_a_case_that_shows_it_again() {
    let output = check(&[&wrong(), "--set", "mistake=3", "--set", "alpha=0.8", "--set", "albedo=1", "--json"]);
    assert_eq!(output.status.code(), Some(3), "{}", text(&output.stderr));
    let report = json(&output);
    assert_eq!((&report["passed"], &report["culprit"]), (&false.into(), &"weight".into()));
    let of = |report: &serde_json::Value| {
        let verdicts = report["verdicts"].as_array().expect("verdicts");
        verdicts.iter().find(|verdict| verdict["test"] == "weight").expect("the test").clone()
    };
    let verdict = of(&report);
    assert_eq!(verdict["outcome"], "failed");
    assert!(verdict["sentence"].as_str().expect("words").starts_with("weight is 1.030 × value / pdf at mistake = 3"), "{verdict}");
    assert!(verdict["statistic"].as_f64() > verdict["threshold"].as_f64() && verdict["inputs"]["wi"].is_array(), "{verdict}");
    let case = verdict["case"].as_str().expect("a case");
    let again = check(&[&wrong(), "--replay", case, "--json"]);
    assert_eq!(again.status.code(), Some(3), "{}", text(&again.stderr));
    assert_eq!(of(&json(&again))["sentence"], verdict["sentence"]);
    let words = text(&check(&[&wrong(), "--replay", case]).stdout);
    assert!(words.lines().last().expect("a line").starts_with("wrong: weight is 1.030"), "{words}");
    // The same place is right without the mistake.
    assert_eq!(check(&[&wrong(), "--replay", &case.replace("mistake=3", "mistake=0")]).status.code(), Some(0));
}

#[test]
fn what_cannot_be_checked_is_an_error_with_a_remedy() {
    refuses(&["ruffconductor"], &["\"ruffconductor\" is no built-in", "did you mean \"roughconductor\"?", "--plugins"]);
    refuses(&["nowhere.wasm"], &["nowhere.wasm", "cannot be read"]);
    refuses(&["twosided"], &["\"twosided\" cannot be checked alone", "inside"]);
    refuses(&["diffuse", "--set", "colour=1"], &["no parameter \"colour\"", "it has reflectance"]);
    refuses(&["diffuse", "--set", "reflectance=red"], &["\"red\" is no value for \"reflectance\"", "rgb"]);
    refuses(&["diffuse", "--set", "reflectance=2"], &["reflectance", "0 … 1"]);
    refuses(&["diffuse", "--replay", "weight"], &["does not say its stream", "copy one"]);
    refuses(&["null", "--replay", "weight/stream=1/effort=14/with/alpha=1"], &["no parameter \"alpha\""]);
}
