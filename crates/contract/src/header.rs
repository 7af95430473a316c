//! What every project file starts with.

use forcewright_base::units::Dimension;

use crate::describe::{Describe, Param, Slot, Visitor};

/// The version of the project-file language that this program reads.
pub const SCHEMA: u32 = 1;

/// Keys that do not depend on the family.
#[derive(Clone, Debug, Default)]
pub struct Header {
    schema: Slot<u32>,
    mechanism: Slot<String>,
    /// The project's title.
    pub title: Slot<String>,
    extends: Slot<String>,
}

impl Describe for Header {
    fn describe(&mut self, v: &mut dyn Visitor) {
        let one = f64::from(SCHEMA);
        v.count(
            &Param::new("schema", "Version of the project-file language.").of(Dimension::Ratio).within(one, one).required(),
            &mut self.schema,
        );
        v.text(&Param::new("mechanism", "Family of the mechanism.").required(), &mut self.mechanism);
        v.text(&Param::new("title", "Title of the project, shown in reports."), &mut self.title);
        v.text(&Param::new("extends", "Another project file; this one is laid over it, key by key."), &mut self.extends);
        v.free(&Param::new("variants", "Named sets of differences, chosen with --variant."));
    }
}
