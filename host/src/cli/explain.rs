//! `bidir explain`.
use crate::{
    cli::{Outcome, arguments::Explain},
    error::Result,
};
pub(super) fn run(_: &Explain) -> Result<Outcome> {
    Ok(Outcome::Done)
}
