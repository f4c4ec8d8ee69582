//! `bidir compare`.

use crate::{
    cli::{Outcome, arguments::Compare},
    compare,
    error::{Error, Result},
    image::read::picture,
};

pub(super) fn run(arguments: &Compare) -> Result<Outcome> {
    let comparison = compare::compare(&picture(&arguments.image)?, &picture(&arguments.reference)?)?;
    if arguments.json {
        let text = serde_json::to_string_pretty(&comparison).map_err(|error| Error::new(format!("no JSON: {error}"), ""))?;
        println!("{text}");
    } else {
        println!("{comparison}");
    }
    Ok(Outcome::Done)
}
