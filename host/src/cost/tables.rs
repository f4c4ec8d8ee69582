//! The figures behind the charts, as comma-separated values.

use std::fmt::Write;

use super::{curve::How, report::Report};

/// Error against time.
pub(super) fn errors(report: &Report) -> String {
    let mut text = "method,seed,spp,cpu,wall,relmse,relmse_trimmed,smape,bias,fireflies\n".to_owned();
    for method in &report.methods {
        for run in method.points.iter().flat_map(|point| &point.runs) {
            let (at, errors) = (&run.snapshot, &run.snapshot.errors);
            let _ = writeln!(
                text,
                "{},{},{},{},{},{},{},{},{},{}",
                method.name, run.seed, at.spp, at.cpu, at.wall, errors.relmse, errors.trimmed, errors.smape, errors.bias, errors.fireflies
            );
        }
    }
    text
}

/// What errors cost.
pub(super) fn prices(report: &Report) -> String {
    let mut text = "method,relmse,cpu,wall,how\n".to_owned();
    for prices in &report.prices {
        for price in &prices.targets {
            let how = match price.how {
                How::Measured => "measured",
                How::Extrapolated => "extrapolated",
                How::Never => "never",
            };
            let _ = writeln!(text, "{},{},{},{},{how}", prices.method, price.relmse, number(price.cpu), number(price.wall));
        }
    }
    text
}

/// What settings cost and bring.
pub(super) fn knobs(report: &Report) -> String {
    let mut text = "knob,setting,base,spp,cpu,relmse,relmse_trimmed,efficiency,bias,bias_low,bias_high,pareto\n".to_owned();
    for knob in &report.knobs {
        for one in &knob.settings {
            let bias = &one.bias.interval;
            let _ = writeln!(
                text,
                "{},{},{},{},{},{},{},{},{},{},{},{}",
                knob.knob,
                one.setting,
                one.base,
                one.spp,
                one.cpu,
                one.relmse,
                one.trimmed,
                number(one.efficiency),
                bias.value,
                number(bias.low),
                number(bias.high),
                one.pareto
            );
        }
    }
    text
}

/// Where time went.
pub(super) fn time(report: &Report) -> String {
    let mut text = "part,seconds,tracing,rays_closest,rays_any\n".to_owned();
    for part in report.time.iter().flat_map(|time| &time.parts) {
        let rays = part.rays.map_or(",".to_owned(), |rays| format!("{},{}", rays.closest, rays.any));
        let _ = writeln!(text, "{},{},{},{rays}", part.name, part.seconds, part.tracing);
    }
    text
}

fn number(value: Option<f64>) -> String {
    value.map_or(String::new(), |value| value.to_string())
}
