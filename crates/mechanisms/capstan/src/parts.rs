//! What is made of a drive: its drums.

use forcewright_model::{NoPart, PartSet};

use crate::design::Design;

pub(crate) fn parts(_design: &Design) -> Result<PartSet, NoPart> {
    Err(NoPart { code: "E0730", message: "x".to_owned(), help: "x".to_owned() })
}
