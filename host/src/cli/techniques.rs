//! `bidir techniques`.
use crate::{
    cli::{Outcome, arguments::Techniques},
    error::Result,
};
pub(super) fn run(_: &Techniques) -> Result<Outcome> {
    Ok(Outcome::Done)
}
