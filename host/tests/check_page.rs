//! The page of `bidir check --report`.

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Output},
};

use roxmltree::{Document, Node, ParsingOptions};
use tempfile::TempDir;

const HARM: &str = include_str!("../../tests/hostile/modules/harm.wat");

fn check(folder: &TempDir, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_bidir"));
    command.current_dir(folder.path()).arg("check").args(arguments).args(["--report", "out/page"]).output().expect("the program")
}

fn prebuilt(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../plugins/prebuilt").join(name).display().to_string()
}

fn place(folder: &TempDir) -> PathBuf {
    folder.path().join("out/page/index.html")
}

/// The page, once it is known to be whole and to need nothing.
fn page(folder: &TempDir) -> String {
    let text = fs::read_to_string(place(folder)).expect("a page");
    for word in ["http", "<script", "<link", "url(", "@import"] {
        assert!(!text.contains(word), "the page holds {word}");
    }
    let names: Vec<_> = fs::read_dir(folder.path().join("out/page")).expect("a folder").collect();
    assert_eq!(names.len(), 1, "{names:?}");
    text
}

fn document(page: &str) -> Document<'_> {
    Document::parse_with_options(page, ParsingOptions { allow_dtd: true, ..ParsingOptions::default() }).expect("balanced tags")
}

fn all<'a>(document: &'a Document<'a>, tag: &'a str) -> impl Iterator<Item = Node<'a, 'a>> {
    document.descendants().filter(move |node| node.has_tag_name(tag))
}

fn of_class<'a>(document: &'a Document<'a>, class: &'a str) -> Vec<Node<'a, 'a>> {
    let has = |node: &Node<'_, '_>| node.attribute("class").is_some_and(|words| words.split(' ').any(|word| word == class));
    document.descendants().filter(has).collect()
}

fn said(node: &Node<'_, '_>) -> String {
    node.descendants().filter_map(|node| node.is_text().then(|| node.text()).flatten()).collect()
}

#[test]
fn a_bsdf_has_a_page_with_a_row_for_each_verdict_and_the_same_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let output = check(&folder, &["diffuse", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let first = page(&folder);
    let document = document(&first);
    assert_eq!(of_class(&document, "verdict").len(), report["verdicts"].as_array().expect("verdicts").len());
    assert_eq!(said(&of_class(&document, "headline")[0]), "All right");
    assert!(of_class(&document, "set").len() > 1 && all(&document, "svg").count() > 4);
    assert!(all(&document, "img").all(|image| image.attribute("src").is_some_and(|uri| uri.starts_with("data:image/png;base64,iVBOR"))));
    check(&folder, &["diffuse", "--threads", "1"]);
    assert!(page(&folder) == first, "the same seed gave other bytes");
}

#[test]
fn a_light_has_a_page() {
    let folder = tempfile::tempdir().expect("a folder");
    let output = check(&folder, &[&prebuilt("spot.wasm")]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let text = page(&folder);
    assert!(text.contains("radiance over the sphere") && !of_class(&document(&text), "set").is_empty());
}

/// Words of an enum are any text. The quotes are those of text inside text inside text.
#[test]
fn hostile_text_stays_text_and_a_plugin_that_breaks_off_has_a_page() {
    let folder = tempfile::tempdir().expect("a folder");
    let word = "</td><script src='http://x'>alert(1)</script>'; rm -r ~; '&amp;";
    let parameter = format!(
        r#"{{\"name\": \"how\", \"type\": \"enum\", \"offset\": 8, \"default\": \"plain\", \"values\": [\"plain\", \"{word}\"]}}, "#
    );
    let text = HARM.replacen("\\\"params\\\": [", &format!("\\\"params\\\": [{}", parameter), 1);
    assert_ne!(text, HARM);
    fs::write(folder.path().join("harm.wasm"), wat::parse_str(text).expect("a module")).expect("a file");
    // Its eval gives up.
    let output = check(&folder, &["harm.wasm", "--set", "eval=4", "--set", &format!("how={word}")]);
    assert_eq!(output.status.code(), Some(3), "{}", String::from_utf8_lossy(&output.stderr));
    let text = fs::read_to_string(place(&folder)).expect("a page");
    assert!(!text.contains("<script") && text.contains("&lt;script src=&#39;"), "the word got out");
    let document = document(&text);
    assert!(of_class(&document, "headline")[0].attribute("class").is_some_and(|class| class.contains("failed")));
    assert!(of_class(&document, "note").iter().any(|note| said(note).contains("bsdf_eval")));
    let codes: Vec<_> = all(&document, "code").map(|code| said(&code)).collect();
    assert!(codes.iter().any(|code| code.contains(r"'\''; rm -r ~; '\''")), "{codes:?}");
}

#[test]
fn a_folder_that_cannot_be_made_is_an_error_before_anything_is_asked() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("out"), "a file").expect("a file");
    let output = check(&folder, &["diffuse"]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(
        output.status.code() == Some(1) && said.starts_with("error: ") && said.contains("cannot be made") && output.stdout.is_empty(),
        "{said}"
    );
}
