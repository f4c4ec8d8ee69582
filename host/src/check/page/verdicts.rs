//! The verdicts of a check, in a page.

use super::markup::{escaped, short};
use crate::check::report::{Outcome, Report, Verdict};

/// What there is to say in one sentence.
pub(super) fn headline(report: &Report) -> String {
    match report.culprit {
        None => "All right".to_owned(),
        Some(first) => {
            format!("Wrong: {}", escaped(report.verdict(first).map_or(first.name(), |verdict| verdict.sentence.as_str())))
        }
    }
}

/// How many tests ended how, what was declared, and what was left out.
pub(super) fn summary(report: &Report) -> String {
    let count = |outcome| report.verdicts.iter().filter(|verdict| verdict.outcome == outcome).count();
    let (passed, failed, exempt) = (count(Outcome::Passed), count(Outcome::Failed), count(Outcome::Excepted));
    let mut lines = vec![format!("{passed} passed, {failed} failed, {exempt} exempt")];
    if !report.observed.is_empty() {
        lines.push(format!("samples came from {}", report.observed.join(", ")));
    }
    lines.extend(report.exceptions.iter().map(|words| format!("declared: {}", escaped(words))));
    lines.extend(report.left_out.iter().map(|words| format!("left out: {}", escaped(words))));
    let lines: String = lines.iter().map(|line| format!("<li>{line}</li>\n")).collect();
    format!("<ul class=\"summary\">\n{lines}</ul>")
}

/// One row for each verdict; `command` comes before what is to be replayed.
pub(super) fn table(report: &Report, command: &str) -> String {
    let rows: String = report.verdicts.iter().map(|verdict| row(verdict, command)).collect();
    format!(
        "<table class=\"verdicts\">\n<thead><tr><th>test</th><th>outcome</th><th class=\"number\">at worst</th>\
         <th class=\"number\">at most</th><th>what was found</th></tr></thead>\n<tbody>\n{rows}</tbody>\n</table>"
    )
}

fn row(verdict: &Verdict, command: &str) -> String {
    let Verdict { test, outcome, sentence, statistic, threshold, judged, failed, case, .. } = verdict;
    let (class, word) = match outcome {
        Outcome::Passed => ("passed", "passed"),
        Outcome::Failed => ("failed", "failed"),
        Outcome::Excepted => ("exempt", "exempt"),
    };
    let (worst, most) = match outcome {
        Outcome::Excepted => ("–".to_owned(), "–".to_owned()),
        _ => (short(*statistic), short(*threshold)),
    };
    let mut found = escaped(sentence);
    if *outcome == Outcome::Failed {
        found += &format!("<br/><span class=\"aside\">in {failed} of {judged} judgments</span>");
    }
    if let Some(case) = case.as_ref().filter(|_| *outcome == Outcome::Failed) {
        let line = format!("{command} --replay {}", quoted(&case.to_string()));
        found += &format!("<br/><code>{}</code>", escaped(&line));
    } else if let Some(case) = case.as_ref().filter(|_| *outcome == Outcome::Passed) {
        let line = format!("{command} --replay {}", quoted(&case.to_string()));
        found += &format!("<details><summary>worst case of {judged}</summary><code>{}</code></details>", escaped(&line));
    }
    let test = test.name();
    format!(
        "<tr class=\"verdict {class}\"><th scope=\"row\">{test}</th><td class=\"outcome\">{word}</td>\
         <td class=\"number\" data-name=\"at worst\">{worst}</td><td class=\"number\" data-name=\"at most\">{most}</td><td class=\"found\">{found}</td></tr>\n"
    )
}

/// As a shell takes it, whatever it holds.
pub fn quoted(text: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "/._-+=:,@%".contains(c);
    if !text.is_empty() && text.chars().all(plain) { text.to_owned() } else { format!("'{}'", text.replace('\'', r"'\''")) }
}

#[cfg(test)]
mod tests {
    use super::quoted;

    #[test]
    fn a_name_cannot_end_its_quotes() {
        assert_eq!(quoted("weight/stream=1/with/alpha=0.1"), "weight/stream=1/with/alpha=0.1");
        assert_eq!(quoted("x'; rm -r ~; '"), r"'x'\''; rm -r ~; '\'''");
        assert_eq!(quoted(""), "''");
    }
}
