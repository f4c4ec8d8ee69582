//! `bidir compare`.

use std::path::Path;

use crate::{
    cli::{Outcome, arguments::Compare},
    compare,
    error::{Error, Result},
    image::{Image, read},
};

pub(super) fn run(arguments: &Compare) -> Result<Outcome> {
    let comparison = compare::compare(&image(&arguments.image)?, &image(&arguments.reference)?)?;
    if arguments.json {
        let text = serde_json::to_string_pretty(&comparison).map_err(|error| Error::new(format!("no JSON: {error}"), ""))?;
        println!("{text}");
    } else {
        println!("{comparison}");
    }
    Ok(Outcome::Done)
}

fn image(path: &Path) -> Result<Image> {
    let pixels = read::read(path, read::Encoding::Srgb)?;
    Ok(Image { width: pixels.width, height: pixels.height, pixels: pixels.values.into_iter().map(|value| value.0).collect() })
}
