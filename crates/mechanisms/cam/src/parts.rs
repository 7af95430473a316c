//! What is made of a design.

use forcewright_model::{NoPart, PartSet};

use crate::design::Design;

/// The plates of a design.
pub(crate) fn parts(_design: &Design) -> Result<PartSet, NoPart> {
    Err(NoPart { code: "E0609", message: "the plates of a cam mechanism are not made yet".to_owned(), help: "export the curve of the path from the report".to_owned() })
}
