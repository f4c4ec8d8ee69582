//! Asks every hard case in every form, or those that are named, and writes the page.

use std::{env, fs, path::Path, process::ExitCode};

use bidir_tests::hard::{
    cases, guards,
    page::{Row, page},
};

fn main() -> ExitCode {
    let Some(folder) = env::args().nth(1) else {
        return usage();
    };
    let Ok(numbers) = env::args().skip(2).map(|number| number.parse()).collect::<Result<Vec<u32>, _>>() else {
        return usage();
    };
    let ask = |case: &bidir_tests::hard::Case| {
        let row = Row::of(case);
        println!("{row}");
        row
    };
    let rows: Vec<_> = cases().iter().filter(|case| numbers.is_empty() || numbers.contains(&case.number)).map(ask).collect();
    if rows.is_empty() {
        return usage();
    }
    let prices = guards::prices();
    for guards::Price { guard, unit, with, without, .. } in &prices {
        println!("{guard}: {with:.1} ns and {without:.1} ns a {unit}, {:.2} ×", with / without);
    }
    let file = Path::new(&folder).join("index.html");
    if let Err(error) = fs::create_dir_all(&folder).and_then(|()| fs::write(&file, page(&rows, &prices))) {
        eprintln!("{} cannot be written: {error}", file.display());
        return ExitCode::from(1);
    }
    println!("{}", file.display());
    if rows.iter().all(Row::holds) { ExitCode::SUCCESS } else { ExitCode::from(3) }
}

fn usage() -> ExitCode {
    eprintln!("usage: hard-cases FOLDER [NUMBER]...");
    ExitCode::from(2)
}
