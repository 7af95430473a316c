//! Values of a project file that the catalogue of materials fills in.

use forcewright_base::diagnostics::{Diagnostic, Diagnostics, Span};
use forcewright_base::text::closest;
use forcewright_base::units::{Quantity, Unit};
use forcewright_elements::materials::{self, Material, Property};

use crate::describe::{Located, Origin, Slot};

/// The entry that a project names with `use`.
#[derive(Clone, Copy, Debug)]
pub struct Named {
    /// What the catalogue knows of it.
    pub entry: &'static Material,
    /// Where the project names it.
    place: Span,
}

impl Named {
    /// Looks it up; a name that the catalogue does not have is reported.
    pub fn find(name: &Located<String>, diagnostics: &mut Diagnostics) -> Option<Self> {
        let found = materials::find(&name.value).map(|entry| Self { entry, place: name.span });
        if found.is_none() {
            let help = "`forcewright materials` lists the catalogue; or leave `use` out and give the values yourself";
            let near = closest(&name.value, materials::names());
            let error = Diagnostic::error("E0308", name.span, "no such material in the catalogue").label("not known").unknown_word();
            diagnostics.push(error.help(near.map_or_else(|| help.to_owned(), |n| format!("did you mean \"{n}\"? {help}"))));
        }
        found
    }

    /// Fills a value that the project does not give; people are shown it in the unit.
    pub fn fill(&self, slot: &mut Slot<Quantity>, property: Option<&Property>, unit: &str) {
        if let (None, Some(property)) = (&slot, property)
            && let Ok(unit) = Unit::parse(unit)
        {
            let value = Quantity { si: property.value, unit, tolerance: None };
            let origin = Origin::Catalogue(format!("{}, {} ({})", self.entry.name, property.kind, property.source));
            *slot = Some(Located { value, span: self.place, origin });
        }
    }
}

/// Sources of those values that the catalogue filled in, each once.
pub fn source_keys<'a>(values: impl IntoIterator<Item = (&'a Slot<Quantity>, Option<&'static Property>)>) -> Vec<&'static str> {
    let filled = |slot: &Slot<Quantity>| matches!(slot, Some(Located { origin: Origin::Catalogue(_), .. }));
    let mut keys: Vec<&'static str> = Vec::new();
    for key in values.into_iter().filter(|(slot, _)| filled(slot)).filter_map(|(_, p)| p).flat_map(Property::source_keys) {
        if !keys.contains(&key) {
            keys.push(key);
        }
    }
    keys
}
