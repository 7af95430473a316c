//! Figures as SVG. An element can stand in a page, where custom properties (`--fw-ink`, `--fw-main`, …) colour it for light, dark and
//! paper, or in a file of its own; it needs no fonts, scripts or other files.

mod bars;
mod canvas;
mod colour;
pub(crate) mod film;
mod legend;
pub(crate) mod parallel;
mod part;
mod place;
mod plot;
pub(crate) mod scatter;
mod scene;
mod spring;
mod symbols;
mod text;
pub mod ticks;

pub use canvas::{Drawing, TextBox};
pub use colour::declarations;
pub use place::Rect;
pub use plot::PlotSize;
pub use scene::SceneSize;

use forcewright_model::{Figure, FigureContent, Film, Plot, Scene};

/// A plot as an SVG element.
pub fn plot(plot: &Plot, size: PlotSize) -> String {
    draw_plot(plot, size).svg
}

/// A picture of a mechanism as an SVG element.
pub fn scene(scene: &Scene, size: SceneSize) -> String {
    draw_scene(scene, size).svg
}

/// A plot with the places of its texts.
pub fn draw_plot(plot: &Plot, size: PlotSize) -> Drawing {
    plot::draw(plot, size, &format!("{} over {}", plot.y.label, plot.x.label), "")
}

/// A picture with the places of its texts.
pub fn draw_scene(scene: &Scene, size: SceneSize) -> Drawing {
    scene::draw(scene, size, "Mechanism", "")
}

/// A figure as an SVG element for a page, titled and described by the figure's words; of a film the chosen frame.
pub fn figure(figure: &Figure) -> String {
    draw_figure(figure).svg
}

/// A film as an SVG element for a page: all frames, of which the element `page_id` around it shows one.
pub(crate) fn film_for_page(figure: &Figure, film: &Film, page_id: &str) -> String {
    film::draw(film, SceneSize::default(), &figure.title, &figure.caption, film::Frames::All, page_id).svg
}

/// A figure with the places of its texts; of a film the chosen frame.
pub fn draw_figure(figure: &Figure) -> Drawing {
    match &figure.content {
        FigureContent::Plot(p) => plot::draw(p, PlotSize::default(), &figure.title, &figure.caption),
        FigureContent::Bars(b) => bars::draw(b, PlotSize::default().width, &figure.title, &figure.caption),
        FigureContent::Scene(s) => scene::draw(s, SceneSize::default(), &figure.title, &figure.caption),
        FigureContent::Film(f) => film::draw(f, SceneSize::default(), &figure.title, &figure.caption, film::Frames::Chosen, ""),
        FigureContent::Part(p) => part::draw(p, SceneSize::default(), &figure.title, &figure.caption),
    }
}

/// A figure as a file of its own: light colours, white ground. Of a film the chosen frame.
pub fn standalone(figure: &Figure) -> String {
    let drawing = draw_figure(figure);
    let style =
        format!("<style>svg{{{}background:#fff}}</style>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n", declarations(false));
    // The first elements are the title and the description; everything drawn follows.
    let svg = drawing.svg.replacen("</desc>\n", &format!("</desc>\n{style}"), 1);
    format!("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{svg}")
}
