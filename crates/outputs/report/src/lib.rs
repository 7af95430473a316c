//! What users keep of a result: the report page, its figures, the result document, the curves as a table.
//!
//! Everything here is a pure function of the data in `forcewright-model`: no clock, no files, no network, the same bytes every time.
//!
//! | function | gives |
//! | --- | --- |
//! | [`html::page`] | the design report, one self-contained page for screen and paper |
//! | [`svg::figure`], [`svg::standalone`] | a figure for a page, or as a file of its own |
//! | [`json::document`] | `result.json`, for scripts |
//! | [`study::page`] | the page of a study, with sections of its own |
//! | [`csv::curves`] | `curves.csv`, for spreadsheets and data frames |

pub mod csv;
pub mod html;
pub mod json;
pub mod study;
pub mod svg;

mod escape;
mod table;
mod words;
