//! Estimators agree: path tracing, light tracing and both heuristics of bidirectional path tracing make one picture.

mod cameras;
mod everywhere;
mod lights;
mod plans;
mod surfaces;

use crate::{
    estimators::{ALL, NOT_LIGHT, NOT_PATH, agree, agree_after},
    pictures::Subject,
};
