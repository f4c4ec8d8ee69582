//! The page: every case in every form, green or red, and what each guard costs.

use std::{fmt::Write, panic::catch_unwind, time::Instant};

use super::{Case, Form, Held, guards::Price, twin};

/// A case as it was found.
#[derive(Debug)]
pub struct Row {
    number: u32,
    what: &'static str,
    seen: &'static str,
    must: &'static str,
    /// By form: native, the f64 twin, the sandbox.
    cells: [Vec<Held>; 3],
    seconds: f64,
}

impl Row {
    /// Asks a case in every form.
    pub fn of(case: &Case) -> Self {
        let start = Instant::now();
        let broken = |_| vec![Held::none("it broke off: what it said stands above", usize::MAX)];
        let asked = |form| catch_unwind(|| (case.run)(form)).unwrap_or_else(broken);
        let [native, sandbox] = [Form::Native, Form::Sandbox].map(asked);
        let twin = catch_unwind(|| twin::of_case(case.number)).unwrap_or_else(broken);
        let seconds = start.elapsed().as_secs_f64();
        Self { number: case.number, what: case.what, seen: case.seen, must: case.must, cells: [native, twin, sandbox], seconds }
    }

    /// Whether everything holds that was asked.
    pub fn holds(&self) -> bool {
        self.cells.iter().flatten().all(Held::holds)
    }
}

impl std::fmt::Display for Row {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:>2} {} {}: {:.1} s", self.number, if self.holds() { "ok  " } else { "FAIL" }, self.what, self.seconds)?;
        for held in self.cells.iter().flatten().filter(|held| !held.holds()) {
            write!(f, "\n        {}: {:e}, at most {:e}", held.what, held.worst, held.bound)?;
        }
        Ok(())
    }
}

/// As columns are called.
const FORMS: [&str; 3] = ["native, f32", "f64 twin", "sandbox"];

/// How many rows the table of hard cases has, with those that wait for media and merging.
const TABLE: usize = 68;

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

fn short(x: f64) -> String {
    match x.abs() {
        0.0 => "0".to_owned(),
        size if (1e-3..1e5).contains(&size) => {
            let text = format!("{x:.*}", (2.0 - size.log10().floor()).clamp(0.0, 5.0) as usize);
            if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
        }
        _ => format!("{x:.1e}"),
    }
}

/// The one that is nearest to its bound, or beyond it most; the others within reach.
fn cell(form: &str, held: &[Held]) -> String {
    let severity = |held: &Held| if held.bound > 0.0 { held.worst / held.bound } else { held.worst * f64::INFINITY };
    let severity = |held: &Held| if held.worst == 0.0 { 0.0 } else { severity(held) };
    let Some(worst) = held.iter().max_by(|a, b| severity(a).total_cmp(&severity(b))) else {
        return "<td class=\"none\">–</td>".to_owned();
    };
    let class = if held.iter().all(Held::holds) { "good" } else { "bad" };
    let lines: String = held
        .iter()
        .map(|held| format!("<li>{}: <b>{}</b>, at most {}</li>", escaped(&held.what), short(held.worst), short(held.bound)))
        .collect();
    let mark = if class == "good" { "✓" } else { "✗" };
    let summary =
        format!("<span class=\"mark\">{mark}</span> {} <span class=\"bound\">≤ {}</span>", short(worst.worst), short(worst.bound));
    format!("<td class=\"{class}\" data-form=\"{form}\"><details><summary>{summary}</summary><ul>{lines}</ul></details></td>")
}

/// The page as it stands in a file: no script, no network.
pub fn page(rows: &[Row], prices: &[Price]) -> String {
    let red = rows.iter().filter(|row| !row.holds()).count();
    let headline = if red == 0 {
        format!("{} of {} cases hold", rows.len(), rows.len())
    } else {
        format!("{red} of {} cases do not hold", rows.len())
    };
    let class = if red == 0 { "good" } else { "bad" };
    let waiting = TABLE - rows.len();
    let mut table = String::new();
    for row in rows {
        let Row { number, what, seen, must, cells, seconds } = row;
        let cells = FORMS.iter().zip(cells).map(|(form, held)| cell(form, held)).collect::<String>();
        let (what, seen, must) = (escaped(what), escaped(seen), escaped(must));
        let _written = writeln!(
            table,
            "<tr><td class=\"number\">{number}</td><th scope=\"row\">{what}<small>{seen}</small></th><td class=\"must\">{must}</td>{cells}<td class=\"number\">{seconds:.1} s</td></tr>"
        );
    }
    let mut costs = String::new();
    for Price { guard, rows, unit, with, without } in prices {
        let _written = writeln!(
            costs,
            "<tr><th scope=\"row\">{}</th><td>{rows}</td><td class=\"number\">{} ns</td><td class=\"number\">{} ns</td><td class=\"number\">{:.2} ×</td><td>a {unit}</td></tr>",
            escaped(guard),
            short(*with),
            short(*without),
            with / without
        );
    }
    let style = include_str!("page.css");
    let forms = FORMS.map(|form| format!("<th>{form}</th>")).concat();
    format!(
        r#"<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"/><meta name="viewport" content="width=device-width, initial-scale=1"/><title>Hard cases</title><style>
{style}</style></head><body>
<h1>Hard cases</h1>
<p class="headline {class}">{headline}</p>
<p>Most of these broke some renderer; the number in small print is that project's issue. A cell shows what comes nearest to its bound; open it for the rest. The f64 twin is the kernel and the standard shaders compiled a second time in f64. In the sandbox the shaders are WebAssembly modules. {waiting} of the table's {TABLE} rows wait for media and merging.</p>
<div class="scroll"><table><thead><tr><th>#</th><th>case, and what it broke</th><th>must hold</th>{forms}<th>took</th></tr></thead><tbody>
{table}</tbody></table></div>
<h2>What the guards cost</h2>
<p>Both forms timed in turn, CPU time, medians. No flag of a render and no Cargo feature turns a guard off.</p>
<div class="scroll"><table><thead><tr><th>guard</th><th>for rows</th><th>with</th><th>without</th><th>ratio</th><th>of</th></tr></thead><tbody>
{costs}</tbody></table></div>
</body></html>
"#
    )
}
