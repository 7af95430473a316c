//! One description per parameter. A design says once what it consists of, by showing its parts to a [`Visitor`]; the reader of project
//! files, the JSON schema, the paths of `--set`, the tables of the documentation and of the report are visitors.

use forcewright_base::diagnostics::Span;
use forcewright_base::units::{Dimension, Quantity};

use crate::data::DataFile;
use crate::tree::Value;

/// Where a value comes from.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Origin {
    /// The project file, what it extends, a variant or `--set`.
    #[default]
    File,
    /// The parameter's default.
    Default,
    /// A catalogue; the text names the entry and the kind of value.
    Catalogue(String),
}

/// A value with its place and origin.
#[derive(Clone, Debug)]
pub struct Located<T> {
    /// The value.
    pub value: T,
    /// Where it stands, or where the table stands that it is missing from.
    pub span: Span,
    /// Where it comes from.
    pub origin: Origin,
}

impl<T> Located<T> {
    /// A value from the file.
    pub fn new(value: T, span: Span) -> Self {
        Self { value, span, origin: Origin::File }
    }
}

/// A parameter's place in a design: empty until it is read.
pub type Slot<T> = Option<Located<T>>;

/// The values a parameter may take, SI.
#[derive(Clone, Copy, Debug)]
pub struct Range {
    /// Smallest value.
    pub min: f64,
    /// Largest value.
    pub max: f64,
    /// Whether the smallest value itself is excluded.
    pub above: bool,
}

impl Range {
    /// Any finite value.
    pub const ANY: Self = Self { min: f64::NEG_INFINITY, max: f64::INFINITY, above: false };

    /// Whether a value lies inside; not-a-number does not.
    pub fn holds(&self, value: f64) -> bool {
        (if self.above { value > self.min } else { value >= self.min }) && value <= self.max
    }
}

/// What is said once about a parameter.
#[derive(Clone, Copy, Debug)]
pub struct Param {
    /// Key in the project file.
    pub key: &'static str,
    /// What it is: one sentence, with the symbol of the literature.
    pub doc: &'static str,
    /// Quantity of its numbers.
    pub dimension: Dimension,
    /// Values accepted, SI.
    pub range: Range,
    /// Whether it must be given where its table is.
    pub required: bool,
    /// Default, written as in the file.
    pub default: Option<&'static str>,
    /// Whether it is the diameter of a shaft or a hole, which takes an ISO 286 fit.
    pub diameter: bool,
}

impl Param {
    /// A dimensionless parameter; the methods say the rest.
    pub const fn new(key: &'static str, doc: &'static str) -> Self {
        Self { key, doc, dimension: Dimension::Ratio, range: Range::ANY, required: false, default: None, diameter: false }
    }

    /// Its quantity.
    pub const fn of(mut self, dimension: Dimension) -> Self {
        self.dimension = dimension;
        self
    }

    /// It is the diameter of a shaft or a hole: a length that takes an ISO 286 fit, `"17.6 mm h7"`.
    pub const fn diameter(mut self) -> Self {
        self.diameter = true;
        self.of(Dimension::Length)
    }

    /// It must be above `min` and at most `max`, SI.
    pub const fn above(mut self, min: f64, max: f64) -> Self {
        self.range = Range { min, max, above: true };
        self
    }

    /// It must be between the two, SI, both allowed.
    pub const fn within(mut self, min: f64, max: f64) -> Self {
        self.range = Range { min, max, above: false };
        self
    }

    /// It must be given.
    pub const fn required(mut self) -> Self {
        self.required = true;
        self
    }

    /// Taken when it is not given; written as in the file.
    pub const fn default(mut self, text: &'static str) -> Self {
        self.default = Some(text);
        self
    }
}

/// One word of a closed set.
#[derive(Clone, Copy, Debug)]
pub struct Word {
    /// As typed.
    pub word: &'static str,
    /// What it means.
    pub doc: &'static str,
}

/// How many members are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// `[design.nodes]` with a key per member.
    Table,
    /// `[[design.beams]]` with a `name` per member.
    List,
    /// `[load]`, or `[[load]]` one after the other. A single table has the empty name, the others are numbered from 1.
    Stages,
}

/// Where a member is found: `design.beams.b1`, and `load` for a single stage.
pub fn member_path(key: &str, name: &str) -> String {
    if name.is_empty() { key.to_owned() } else { format!("{key}.{name}") }
}

/// A quantity that may vary along something.
#[derive(Clone, Debug, PartialEq)]
pub enum Along {
    /// The same everywhere.
    Constant(Quantity),
    /// At places from 0 to 1, linear between them.
    Places(Vec<(f64, Quantity)>),
}

impl Along {
    /// The quantity where it is the same everywhere, or at the first place.
    pub fn first(&self) -> Option<&Quantity> {
        match self {
            Self::Constant(quantity) => Some(quantity),
            Self::Places(places) => places.first().map(|p| &p.1),
        }
    }
}

impl std::fmt::Display for Along {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Constant(quantity) => quantity.fmt(f),
            Self::Places(places) => {
                let shown: Vec<String> = places.iter().map(|(u, q)| format!("[{u}, {q}]")).collect();
                write!(f, "[{}]", shown.join(", "))
            }
        }
    }
}

/// A key that the language has but this version does not.
#[derive(Clone, Copy, Debug)]
pub struct Reserved {
    /// The key.
    pub key: &'static str,
    /// What to do instead, or what it will be for.
    pub instead: &'static str,
    /// Whether the file can be used without it: a section that only a study reads.
    pub ignored: bool,
}

/// What looks at a description. Values are shown as mutable slots: a reader fills them, a table prints them. A visitor leaves out the
/// kinds of values that it has no use for; tables and members it must go into.
pub trait Visitor {
    /// A number with a unit and perhaps a tolerance; bare where it is dimensionless.
    fn quantity(&mut self, _param: &Param, _slot: &mut Slot<Quantity>) {}
    /// A bare whole number.
    fn count(&mut self, _param: &Param, _slot: &mut Slot<u32>) {}
    /// A list of bare numbers, at most 32.
    fn numbers(&mut self, _param: &Param, _slot: &mut Slot<Vec<f64>>) {}
    /// A list of quantities `["0.683 N/mm", "0.682 N/mm"]`, at most `most`.
    fn quantities(&mut self, _param: &Param, _most: usize, _slot: &mut Slot<Vec<Quantity>>) {}
    /// A curve `[["0 mm", "40 N"], …]` of pairs of two kinds of quantities, that of the parameter second; at most `most`.
    fn pairs(&mut self, _param: &Param, _first: Dimension, _most: usize, _slot: &mut Slot<Vec<Located<[Quantity; 2]>>>) {}
    /// A point `["x", "y"]` of two quantities.
    fn point(&mut self, _param: &Param, _slot: &mut Slot<[Quantity; 2]>) {}
    /// Points `[["x", "y"], …]`, at most `most`.
    fn points(&mut self, _param: &Param, _most: usize, _slot: &mut Slot<Vec<Located<[Quantity; 2]>>>) {}
    /// A quantity, or pairs `[["0", "1 mm"], ["1", "0.6 mm"]]` of ascending places from 0 to 1 and quantities, at most `most`.
    fn along(&mut self, _param: &Param, _most: usize, _slot: &mut Slot<Along>) {}
    /// A value whose quantity follows from another key: kept as it stands, and read when that key is known.
    fn deferred(&mut self, _param: &Param, _slot: &mut Slot<Value>) {}
    /// A direction `[x, y]` of two bare numbers, not both zero.
    fn direction(&mut self, _param: &Param, _slot: &mut Slot<[f64; 2]>) {}
    /// Free text.
    fn text(&mut self, _param: &Param, _slot: &mut Slot<String>) {}
    /// The path of a file beside the project, whose key is `file` or ends in `_file` ([`crate::data::names_a_file`]).
    fn file(&mut self, _param: &Param, _slot: &mut Slot<DataFile>) {}
    /// `true` or `false`.
    fn flag(&mut self, _param: &Param, _slot: &mut Slot<bool>) {}
    /// One word of a closed set.
    fn choice(&mut self, _param: &Param, _words: &'static [Word], _slot: &mut Slot<&'static str>) {}
    /// Names of other members, at least `least` and at most `most`.
    fn names(&mut self, _param: &Param, _least: usize, _most: usize, _slot: &mut Slot<Vec<Located<String>>>) {}
    /// A table of its own; `present` is filled where it is given.
    fn section(&mut self, param: &Param, present: &mut Slot<()>, body: &mut dyn FnMut(&mut dyn Visitor));
    /// Members with names.
    fn members(&mut self, param: &Param, form: Form, members: &mut dyn Members);
    /// Members that are tables of this table itself, beside its keys; shown last. The key of `param` is `*`.
    fn tables(&mut self, param: &Param, members: &mut dyn Members);
    /// A table whose content is not described here: it is merged before anything is read.
    fn free(&mut self, _param: &Param) {}
    /// Keys of this table that the language has but this version does not.
    fn reserved(&mut self, _keys: &'static [Reserved]) {}
}

/// Something that can be described.
pub trait Describe {
    /// Shows every part to the visitor, in the order of the documentation.
    fn describe(&mut self, visitor: &mut dyn Visitor);
}

/// A member of a named collection.
#[derive(Clone, Debug)]
pub struct Member<T> {
    /// Its name.
    pub name: Located<String>,
    /// What it is.
    pub value: T,
}

/// A named collection, seen by a visitor.
pub trait Members {
    /// Names, in the order of the file.
    fn names(&self) -> Vec<String>;
    /// Adds an empty member.
    fn add(&mut self, name: Located<String>);
    /// Shows one member.
    fn describe(&mut self, index: usize, visitor: &mut dyn Visitor);
    /// Shows an empty member: what any member consists of.
    fn prototype(&self, visitor: &mut dyn Visitor);
}

impl<T: Describe + Default> Members for Vec<Member<T>> {
    fn names(&self) -> Vec<String> {
        self.iter().map(|m| m.name.value.clone()).collect()
    }

    fn add(&mut self, name: Located<String>) {
        self.push(Member { name, value: T::default() });
    }

    fn describe(&mut self, index: usize, visitor: &mut dyn Visitor) {
        if let Some(member) = self.get_mut(index) {
            member.value.describe(visitor);
        }
    }

    fn prototype(&self, visitor: &mut dyn Visitor) {
        T::default().describe(visitor);
    }
}

/// A table of its own: what stands in it, and whether it is there.
#[derive(Clone, Debug, Default)]
pub struct Section<T> {
    /// Filled where the table is given; its span is the table's header.
    pub present: Slot<()>,
    /// What stands in it.
    pub body: T,
}

impl<T: Describe> Section<T> {
    /// Shows the table to a visitor.
    pub fn describe(&mut self, visitor: &mut dyn Visitor, param: &Param) {
        let Self { present, body } = self;
        visitor.section(param, present, &mut |v| body.describe(v));
    }
}

impl<T> std::ops::Deref for Section<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.body
    }
}

impl<T> std::ops::DerefMut for Section<T> {
    fn deref_mut(&mut self) -> &mut T {
        &mut self.body
    }
}
