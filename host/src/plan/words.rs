//! Plans in words.

use super::{
    Stage,
    choice::{Candidate, Choice},
    plugins::Plugin,
};

/// What a stage samples.
pub fn stage(stage: &Stage) -> String {
    let walks = stage.techniques().light_walks();
    let mut parts = Vec::new();
    if stage.techniques().camera_walk() {
        parts.push(match stage.next_event {
            0.0 => "camera paths".to_owned(),
            1.0 => "camera paths with next event".to_owned(),
            count => format!("camera paths with {count} next events per vertex"),
        });
    }
    if walks > 0.0 {
        let shown = if stage.lens_splat > 0.0 { " shown to the lens" } else { "" };
        parts.push(match walks {
            1.0 => format!("a light path each{shown}"),
            walks => format!("{walks} light paths each{shown}"),
        });
    }
    if stage.connection > 0.0 {
        parts.push(if stage.connection == walks {
            "all connections".to_owned()
        } else {
            format!("{} of their connections", share(stage.connection / walks))
        });
    }
    if parts.is_empty() { "nothing".to_owned() } else { parts.join(", ") }
}

fn share(x: f64) -> String {
    format!("{:.0} %", 100.0 * x)
}

/// A plan in a line: what it samples, and how much better that is than the plans that have a name.
pub fn line(chosen: &Stage, choice: Option<&Choice>) -> String {
    let words = stage(chosen);
    match choice {
        Some(choice) => format!("{words} ({})", against(choice)),
        None => words,
    }
}

/// How the plan compares with path tracing and with every technique once.
fn against(choice: &Choice) -> String {
    let of = |name: &str, wanted: super::Named| {
        let wanted = wanted.stage()?;
        let like = |candidate: &&Candidate| alike(&candidate.stage, &wanted);
        let candidate = choice.candidates.iter().find(like)?;
        Some(if alike(&choice.chosen.stage, &wanted) {
            format!("which is {name}")
        } else if candidate.error.is_none() {
            format!("{name} would miss light")
        } else {
            format!("{:.2} times as efficient as {name}", choice.chosen.efficiency() / candidate.efficiency())
        })
    };
    let all = [of("path", super::Named::Path), of("bdpt", super::Named::Bdpt)];
    all.into_iter().flatten().collect::<Vec<_>>().join(", ")
}

/// The plan card: what was chosen, what it rests on, and what would change it.
pub fn card(choice: &Choice) -> Vec<String> {
    let Choice { chosen, candidates, costs, camera_paths, watched, beyond, times, joins, plugins, without_plugins, .. } = choice;
    let mut lines = vec![
        format!("auto: {}", stage(&chosen.stage)),
        format!(
            "from a pilot of {camera_paths} camera paths, each with a light path{}; relMSE times samples per pixel about {}",
            if *watched > 0 { format!(", and {watched} of the render's own, which were watched") } else { String::new() },
            error(chosen)
        ),
        format!(
            "a camera path takes {}, {} of it next event, and {} more beside light paths; a light path {}, all connections {}",
            time(costs.camera_path),
            time(costs.next_event),
            time(costs.beside.max(0.0)),
            time(costs.light_path),
            time(costs.connections)
        ),
    ];
    if *times > 1.0 {
        lines.push(format!("the render was {times:.2} times as noisy as the pilot said; that is held against plans that leave a join out"));
    }
    if *beyond > 0.0 {
        lines.push(format!("{beyond:.3} of that the render saw and the pilot did not; it is taken to be the same by every plan"));
    }
    for worth in joins {
        let saved = match worth.error_without {
            Some(times) => format!("without it the error would be {times:.2} times as large"),
            None => "without it light would be missing".to_owned(),
        };
        lines.push(format!("{:<11} {:>4} of the time; {saved}", worth.join.replace('_', " "), share(worth.cost)));
    }
    let other = without_plugins.map(|other| other.stage).filter(|other| other.techniques() != chosen.stage.techniques());
    // What neither takes time nor decides is left out.
    lines.extend(plugins.iter().filter(|plugin| other.is_some() || plugin.share >= 0.01).map(plugin));
    let against = against(choice);
    if !against.is_empty() {
        lines.push(against);
    }
    lines.extend(candidates.iter().find(|other| other.stage != chosen.stage && other.error.is_some()).map(|other| change(chosen, other)));
    if without_plugins.is_some() {
        let words = other.map_or("this plan would be chosen too".to_owned(), |other| format!("it would be: {}", stage(&other)));
        lines.push(format!("if calls of plugins took no time, {words}"));
    }
    lines
}

/// A plugin's part in a sample, and where its calls come from.
fn plugin(plugin: &Plugin) -> String {
    let Plugin { module, calls, nanoseconds, share: part, calls_in } = plugin;
    let [camera, light, connected] = [calls_in.camera_path, calls_in.light_path, calls_in.connections].map(count);
    format!(
        "plugin {module}: {} calls of {} a sample, {} of the time; {camera} in a camera path, {light} in a light path, \
         {connected} in all connections",
        count(*calls),
        time(*nanoseconds),
        share(*part),
    )
}

fn count(calls: f64) -> String {
    if calls < 1.0 { format!("{calls:.2}") } else { format!("{calls:.1}") }
}

/// What would make the next best plan the best one.
fn change(chosen: &Candidate, other: &Candidate) -> String {
    let ahead = chosen.efficiency() / other.efficiency();
    let words = stage(&other.stage);
    if ahead <= 1.0 {
        return format!("as good: {words}");
    }
    let dearer = other.cost > chosen.cost;
    let how = if dearer {
        format!("cost {:.0} % less", 100.0 * (1.0 - 1.0 / ahead))
    } else {
        format!("had an error {:.0} % smaller", 100.0 * (1.0 - 1.0 / ahead))
    };
    format!("next best: {words}; it would be chosen if it {how}")
}

fn error(candidate: &Candidate) -> String {
    candidate.error.map_or("unknown".to_owned(), |error| format!("{error:.3}"))
}

fn time(nanoseconds: f64) -> String {
    if nanoseconds < 1e4 { format!("{nanoseconds:.0} ns") } else { format!("{:.1} µs", nanoseconds * 1e-3) }
}

/// Whether two stages differ only in joins that cannot be made in the scene.
fn alike(a: &Stage, b: &Stage) -> bool {
    let (a, b) = (a.techniques(), b.techniques());
    let same = |x: f64, y: f64| x == y || x == 0.0 && y == 1.0;
    same(a.light_hit, b.light_hit)
        && same(a.next_event, b.next_event)
        && a.connection == b.connection
        && a.lens_splat == b.lens_splat
        && same(a.lens_hit, b.lens_hit)
}
