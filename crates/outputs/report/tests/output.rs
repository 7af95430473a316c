//! The outputs of a whole report: well formed, complete, escaped, without requests, the same every time.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

#[allow(unreachable_pub, reason = "shared with the example")]
mod fixture;

use forcewright_base::units::Dimension;
use forcewright_model::{CheckState, FigureContent, Item, Role, StatusKind, Stroke};
use forcewright_report::svg::{self, Drawing, PlotSize, Rect, SceneSize};
use forcewright_report::{csv, html, json};
use roxmltree::{Document, ParsingOptions};

fn parse(text: &str) -> Document<'_> {
    Document::parse_with_options(text, ParsingOptions { allow_dtd: true, ..ParsingOptions::default() }).unwrap()
}

/// Every text inside the drawing, no two of them over each other.
fn texts_are_apart(drawing: &Drawing) {
    let all = Rect { x0: 0.0, y0: 0.0, x1: drawing.width, y1: drawing.height };
    for (i, a) in drawing.texts.iter().enumerate() {
        assert!(all.contains(&a.rect), "outside: {a:?} of {} × {}", drawing.width, drawing.height);
        for b in &drawing.texts[i + 1..] {
            assert!(!a.rect.overlaps(&b.rect), "{a:?} over {b:?}");
        }
    }
}

fn nothing_is_requested(markup: &str) {
    let bare = markup.replace("xmlns=\"http://www.w3.org/2000/svg\"", "").replace("http-equiv", "");
    for sign in ["http", "//", "url(", "@import", "<script", "src=", "<iframe", "<object", "srcset", "ping="] {
        assert!(!bare.contains(sign), "{sign}");
    }
    assert_eq!(bare.matches("href=").count(), bare.matches("href=\"data:,\"").count());
}

#[test]
fn the_page_is_well_formed_complete_and_small() {
    let report = fixture::report();
    let page = html::page(&report);
    assert!(page.len() < 1_000_000, "{} bytes", page.len());
    nothing_is_requested(&page);
    let document = parse(&page);
    let ids: Vec<&str> = document.descendants().filter_map(|n| n.attribute("id")).collect();
    let wanted = [
        "figure-mechanism",
        "figure-force",
        "figure-stress",
        "requirements",
        "checks",
        "warnings",
        "metrics",
        "parameters",
        "model",
        "limits",
        "sources",
        "accuracy",
        "provenance",
    ];
    for id in wanted {
        assert!(ids.contains(&id), "{id}");
    }
    let mut unique = ids.clone();
    unique.sort_unstable();
    unique.dedup();
    assert_eq!(unique.len(), ids.len());
    let root = document.root_element();
    assert_eq!(root.attribute("lang"), Some("en"));
    for table in document.descendants().filter(|n| n.has_tag_name("table")) {
        assert!(table.children().any(|c| c.has_tag_name("caption")));
        assert!(table.descendants().filter(|n| n.has_tag_name("th")).all(|th| th.attribute("scope").is_some()));
        let columns = table.descendants().filter(|n| n.has_tag_name("th") && n.attribute("scope") == Some("col")).count();
        for row in table.descendants().filter(|n| n.has_tag_name("tr")) {
            assert_eq!(row.children().filter(roxmltree::Node::is_element).count(), columns);
        }
    }
    let data = document.descendants().filter(|n| n.has_tag_name("details"));
    assert!(data.clone().count() == 2 && data.clone().all(|d| d.descendants().filter(|n| n.has_tag_name("tr")).count() <= 26));
    for text in [
        "1 of 5 requirements missed, 1 not assessed",
        "+4.8 %",
        "48.22 MPa",
        "≤ 50.67 MPa",
        "thin &amp; light",
        "COMP020",
        "lan2010",
        "newton_<wbr />iterations",
        "1 mm ± 0.02 mm",
        &report.input_sha256,
    ] {
        assert!(page.contains(text), "{text}");
    }
}

#[test]
fn backticks_become_code_on_the_page_only() {
    let mut report = fixture::report();
    report.outcome.warnings[0].message = "beam `b2` and `design.beam_depth`; `<b>`, one ` alone".to_owned();
    report.outcome.checks[0].basis = "over `requirements.travel`".to_owned();
    report.outcome.checks[0].advice = Some("raise `b1`".to_owned());
    report.outcome.status.kind = StatusKind::NoEquilibriumBeyond;
    report.outcome.status.advice = Some("lower `b2`".to_owned());
    report.parameters[0].doc = "as `b3`".to_owned();
    report.model[0].text = "see `b4`".to_owned();
    let page = html::page(&report);
    parse(&page);
    for text in [
        "beam <code>b2</code> and <code>design.<wbr />beam_<wbr />depth</code>; <code>&lt;b&gt;</code>, one ` alone",
        "over <code>requirements.<wbr />travel</code>",
        "→ raise <code>b1</code>",
        "→ lower <code>b2</code>",
        "as <code>b3</code>",
        "see <code>b4</code>",
    ] {
        assert!(page.contains(text), "{text}");
    }
    assert!(!page.contains("<b>"));
    let document = json::document(&report.outcome, "", "");
    assert_eq!(document["checks"][0]["basis"], "over `requirements.travel`");
}

#[test]
fn margins_are_limited_and_numbers_have_true_minus_signs() {
    let mut report = fixture::report();
    let margins = [-70_657.081, 70_657.081, -0.25, f64::INFINITY, f64::NAN];
    for (check, margin) in report.outcome.checks.iter_mut().zip(margins) {
        check.margin = Some(margin);
    }
    let page = html::page(&report);
    let document = parse(&page);
    let cells = |class: &str| -> Vec<String> {
        document
            .descendants()
            .filter(|n| n.has_tag_name("td") && n.attribute("class") == Some("number"))
            .filter(|n| n.ancestors().any(|a| a.has_tag_name("table") && a.attribute("class") == Some(class)))
            .map(|n| n.text().unwrap_or_default().to_owned())
            .collect()
    };
    let shown: Vec<String> = cells("checks").into_iter().skip(2).step_by(3).take(margins.len()).collect();
    assert_eq!(shown, ["< −1000 %", "> +1000 %", "−25.0 %", "> +1000 %", "–"]);
    assert!(cells("metrics").contains(&"−0.02009 N/mm".to_owned()));
    for class in ["checks", "metrics", "parameters", "data"] {
        assert!(!cells(class).is_empty() && cells(class).iter().all(|c| !c.contains('-')), "{class}: {:?}", cells(class));
    }
}

#[test]
fn zero_has_no_sign() {
    let mut outcome = fixture::outcome();
    for curve in &mut outcome.curves {
        curve.branches[0].x[0] = -0.0;
        curve.branches[0].y[0] = -0.0;
    }
    outcome.metrics[0].value = -0.0;
    outcome.error_estimate = Some(-0.0);
    (outcome.checks[0].value, outcome.checks[0].limit, outcome.checks[0].margin) = (Some(-0.0), Some(-0.0), Some(-0.0));
    let wide = csv::curves(&outcome);
    assert!(wide.contains("\r\nloading,0,0,0\r\n"));
    outcome.curves[1].branches[0].name = "other".to_owned();
    assert!(csv::curves(&outcome).contains("\r\nforce,loading,0,0,"));
    let text = json::document(&outcome, "", "").to_string();
    assert!(!text.contains("-0.0,") && !text.contains("-0.0]") && !text.contains("-0.0}") && !text.contains("-0,"));
}

#[test]
fn quantities_stand_over_their_units_and_lines_keep_their_order() {
    let mut plot = fixture::force_plot();
    plot.y.display = fixture::unit("N/mm");
    let labels = ["b1", "b2", "b3"];
    for (series, label) in plot.series.iter_mut().zip(labels) {
        series.label = label.to_owned();
    }
    let count = plot.series.len();
    let drawing = svg::draw_plot(&plot, PlotSize::default());
    let has = |drawing: &Drawing, text: &str| drawing.texts.iter().any(|t| t.text == text);
    assert!(has(&drawing, "Displacement Δ / mm") && drawing.texts.iter().any(|t| t.text.ends_with(" / (N/mm)")));
    let named: Vec<&str> = drawing.texts.iter().map(|t| t.text.as_str()).filter(|t| labels.contains(t)).collect();
    assert!(count > 1);
    assert_eq!(named, labels[..count]);
    let scene = svg::draw_scene(&fixture::scene(), SceneSize::default());
    assert!(scene.texts.iter().any(|t| t.text.ends_with(" / MPa")) && has(&scene, "mirror line"));
    // What is rigid and the envelope are named where they are drawn.
    let mut more = fixture::scene();
    assert!(!has(&scene, "envelope") && has(&scene, "rigid"));
    more.items.retain(|i| !matches!(i, Item::Body { .. }));
    assert!(!has(&svg::draw_scene(&more, SceneSize::default()), "rigid"));
    for role in [Role::Rigid, Role::Envelope] {
        more.items.push(Item::Line { points: vec![[0.0; 2], [0.01, 0.0]], width_m: 1e-3, role, values: None });
    }
    let named = svg::draw_scene(&more, SceneSize::default());
    assert!(has(&named, "rigid") && has(&named, "envelope") && has(&named, "mirror line"));
    assert!(html::page(&fixture::report()).contains(">Displacement Δ / mm</th>"));
}

#[test]
fn the_verdict_says_it_in_words_and_marks() {
    let mut report = fixture::report();
    let verdict = |page: &str| page.split("<p class=\"verdict").nth(1).and_then(|p| p.split("</p>").next()).unwrap().to_owned();
    assert!(verdict(&html::page(&report)).contains('✗'));
    for check in &mut report.outcome.checks {
        if check.state == CheckState::Missed {
            check.state = CheckState::Met;
        }
    }
    assert!(verdict(&html::page(&report)).contains("1 of 5 requirements not assessed, 4 met") && html::page(&report).contains(">?<"));
    for check in &mut report.outcome.checks {
        check.state = CheckState::Met;
    }
    assert!(verdict(&html::page(&report)).contains("All 5 requirements met"));
    report.outcome.checks.clear();
    assert!(verdict(&html::page(&report)).contains("No requirements"));
    assert!(!html::page(&report).contains("id=\"status\""));
    report.outcome.status.kind = StatusKind::NoEquilibriumBeyond;
    report.outcome.status.advice = Some("ask for less than 11 mm".to_owned());
    let page = html::page(&report);
    assert!(page.contains("Analysis: no equilibrium beyond.") && page.contains("ask for less than 11 mm"));
    parse(&page);
}

#[test]
fn text_from_files_never_becomes_markup() {
    let mut report = fixture::report();
    let nasty = "</title><script>alert(\"x\")</script><img src=x onerror='y'>&amp;\u{1}]]>";
    report.outcome.title = String::from(nasty);
    report.family = String::from(nasty);
    report.variant = Some(nasty.to_owned());
    report.input_name = String::from(nasty);
    report.command = String::from(nasty);
    report.version = String::from(nasty);
    report.input_sha256 = String::from(nasty);
    for check in &mut report.outcome.checks {
        check.title = String::from(nasty);
        check.basis = String::from(nasty);
        check.advice = Some(nasty.to_owned());
    }
    for figure in &mut report.figures {
        figure.title = String::from(nasty);
        figure.caption = String::from(nasty);
        match &mut figure.content {
            FigureContent::Plot(plot) => {
                plot.x.label = String::from(nasty);
                plot.series[0].label = String::from(nasty);
                plot.markers[0].label = String::from(nasty);
                plot.markers[0].note = String::from(nasty);
            }
            FigureContent::Scene(scene) => scene.description = nasty.to_owned(),
            FigureContent::Film(film) => {
                film.axis.label = String::from(nasty);
                film.frames[3].note = String::from(nasty);
                film.stage.description = String::from(nasty);
            }
            FigureContent::Bars(bars) => {
                bars.axis.label = String::from(nasty);
                bars.rows[0].label = String::from(nasty);
                bars.series[0].0 = String::from(nasty);
            }
            FigureContent::Part(set) => set.parts[0].name = nasty.to_owned(),
        }
    }
    let page = html::page(&report);
    let document = parse(&page);
    assert!(!page.contains("<script") && !page.contains("<img"));
    assert!(document.descendants().all(|n| !n.has_tag_name("script") && !n.has_tag_name("img")));
    let shown = nasty.replace('\u{1}', "");
    assert!(document.descendants().any(|n| n.has_tag_name("h1") && n.text() == Some(&shown)));
}

#[test]
fn figures_stand_alone_and_nothing_in_them_overlaps() {
    for figure in &fixture::report().figures {
        let drawing = svg::draw_figure(figure);
        texts_are_apart(&drawing);
        let file = svg::standalone(figure);
        nothing_is_requested(&file);
        let document = Document::parse(&file).unwrap();
        let root = document.root_element();
        assert_eq!(root.attribute("role"), Some("img"));
        let child = |name: &str| root.children().find(|c| c.has_tag_name((root.tag_name().namespace().unwrap(), name)));
        assert_eq!(child("title").unwrap().text(), Some(figure.title.as_str()));
        assert!(child("desc").unwrap().text().unwrap().contains(&figure.caption));
        assert!(child("style").unwrap().text().unwrap().contains("--fw-ink"));
        assert!(drawing.texts.iter().all(|t| file.contains(&t.text)));
    }
}

/// The figure of a film in the page of the fixture.
fn film_page() -> String {
    let page = html::page(&fixture::report());
    let start = page.find("<figure id=\"figure-film\"").unwrap();
    page[start..start + page[start..].find("</figure>").unwrap() + 9].to_owned()
}

#[test]
fn a_film_has_a_button_and_a_label_for_each_frame_and_shows_one() {
    let markup = film_page();
    nothing_is_requested(&markup);
    let document = parse(&markup);
    let all = |name: &str| document.descendants().filter(|n| n.tag_name().name() == name).collect::<Vec<_>>();
    let fieldset = all("fieldset")[0];
    assert_eq!((fieldset.attribute("id"), all("legend")[0].text()), (Some("film-film"), Some("Angle φ / deg")));
    let (buttons, labels) = (all("input"), all("label"));
    assert_eq!((buttons.len(), labels.len()), (25, 25));
    for (i, (button, label)) in buttons.iter().zip(&labels).enumerate() {
        assert_eq!((button.attribute("type"), button.attribute("name")), (Some("radio"), Some("film-film")));
        assert_eq!((label.attribute("for"), button.attribute("checked").is_some()), (button.attribute("id"), i == 12));
        // What is read aloud begins with what is seen.
        assert!(button.attribute("aria-label").unwrap().starts_with(label.text().unwrap().trim_end_matches('…')), "{i}");
        assert_eq!(button.parent(), Some(fieldset));
    }
    assert_eq!(labels[2].text(), Some("15"));
    // Without a style all frames but the chosen one stay hidden.
    let frames: Vec<_> = all("g").into_iter().filter(|g| g.attribute("class").is_some_and(|c| c.starts_with("k "))).collect();
    assert_eq!(frames.len(), 25);
    for (i, frame) in frames.iter().enumerate() {
        assert_eq!(frame.attribute("display"), (i != 12).then_some("none"), "{i}");
        assert_eq!(frame.parent().unwrap().tag_name().name(), "svg", "the style looks for children of the drawing");
    }
    let style = all("style")[0].text().unwrap();
    for i in 0..25 {
        assert!(style.contains(&format!("#film-film>.k{i}:checked~svg>.k{i}{{display:inline}}")), "{i}");
        assert!(style.contains(&format!(".strip>label.k{i}:hover)>svg>g.k.k{i}{{display:inline}}")), "{i}");
    }
}

#[test]
fn frames_of_a_film_share_paper_scale_and_what_does_not_move() {
    let mut figure = fixture::report().figures.into_iter().find(|f| f.id == "film").unwrap();
    let page = film_page();
    assert!(page.len() < 60_000, "{} bytes", page.len());
    let mut sizes = Vec::new();
    for chosen in 0..25 {
        let FigureContent::Film(film) = &mut figure.content else { panic!("a film") };
        film.chosen = chosen;
        let drawing = svg::draw_figure(&figure);
        texts_are_apart(&drawing);
        assert!(drawing.texts.iter().any(|t| t.text.starts_with(&format!("Angle φ = {} deg: ", 7.5 * chosen as f64))), "{chosen}");
        assert!(!drawing.svg.contains("display=") && drawing.svg.matches("class=\"k ").count() == 1, "one frame in a file");
        sizes.push((drawing.width.to_bits(), drawing.height.to_bits()));
        // The plate is in one place in all of them, and once in the page.
        let plate = drawing.svg.lines().find(|l| l.contains("Z\"")).unwrap().to_owned();
        assert_eq!(page.matches(&plate).count(), 1, "{chosen}");
    }
    sizes.dedup();
    assert_eq!(sizes.len(), 1);
    let FigureContent::Film(film) = &mut figure.content else { panic!("a film") };
    film.chosen = 99;
    assert!(svg::standalone(&figure).contains("180"), "the last one");
    let FigureContent::Film(film) = &mut figure.content else { panic!("a film") };
    film.frames.clear();
    let still = svg::standalone(&figure);
    assert!(still.contains("base") && !still.contains("class=\"k "));
    texts_are_apart(&svg::draw_figure(&figure));
}

#[test]
fn bars_reach_from_zero_to_both_ends() {
    let figure = fixture::report().figures.into_iter().find(|f| f.id == "sensitivity").unwrap();
    let drawing = svg::draw_figure(&figure);
    let has = |text: &str| drawing.texts.iter().any(|t| t.text == text);
    assert!(has("−6 … +6.1") && has("– … +0.5") && has("0 … +0.01") && has("thickness ± 0.02 mm"));
    let document = Document::parse(&drawing.svg).unwrap();
    let number = |n: &roxmltree::Node<'_, '_>, key: &str| n.attribute(key).unwrap().parse::<f64>().unwrap();
    let bars: Vec<_> = document.descendants().filter(|n| n.has_tag_name(("http://www.w3.org/2000/svg", "rect"))).collect();
    // The first row's bars of the mean force: the filled one to +6.1 %, the outlined one to −6 %.
    let (filled, outlined) = (bars[0], bars[1]);
    assert_eq!(outlined.attribute("fill"), Some("none"));
    assert!((number(&filled, "width") / number(&outlined, "width") - 6.1 / 6.0).abs() < 1e-3);
    assert!((number(&outlined, "x") + number(&outlined, "width") - number(&filled, "x")).abs() < 0.02, "both begin at zero");
}

#[test]
fn a_region_is_filled_and_has_no_points_in_the_table() {
    let mut report = fixture::report();
    let FigureContent::Plot(plot) = &mut report.figures[1].content else { panic!("a plot") };
    plot.series[0].stroke = Stroke::Area;
    plot.series[0].label = "the region".to_owned();
    let page = html::page(&report);
    parse(&page);
    assert!(page.contains("fill-opacity=\"0.2\"") && page.contains(">the region</text>") && !page.contains(">the region</th>"));
}

#[test]
fn figures_of_every_size_keep_their_texts_apart() {
    for (width, height) in [(320.0, 160.0), (480.0, 300.0), (760.0, 360.0), (1280.0, 500.0), (f64::NAN, -1.0)] {
        for plot in [fixture::force_plot(), fixture::stress_plot()] {
            texts_are_apart(&svg::draw_plot(&plot, PlotSize { width, height }));
        }
        texts_are_apart(&svg::draw_scene(&fixture::scene(), SceneSize { width, max_height: height }));
    }
    assert_eq!(svg::plot(&fixture::force_plot(), PlotSize::default()), svg::draw_plot(&fixture::force_plot(), PlotSize::default()).svg);
    assert!(svg::scene(&fixture::scene(), SceneSize::default()).starts_with("<svg"));
}

#[test]
fn styles_differ_without_colour() {
    let svg = svg::plot(&fixture::force_plot(), PlotSize::default());
    assert!(svg.contains("stroke-dasharray=\"6 4\""), "the reference is dashed");
    let mut plot = fixture::force_plot();
    for (series, stroke) in plot.series.iter_mut().zip([Stroke::Third, Stroke::Limit, Stroke::Main]) {
        series.stroke = stroke;
    }
    let svg = svg::plot(&plot, PlotSize::default());
    assert!(svg.contains("stroke-dasharray=\"11 4 2.5 4\"") && svg.contains("stroke-dasharray=\"10 5\""));
}

#[test]
fn a_level_far_beyond_the_data_is_told_but_does_not_flatten_them() {
    let drawing = svg::draw_plot(&fixture::stress_plot(), PlotSize::default());
    let has = |text: &str| drawing.texts.iter().any(|t| t.text.contains(text));
    assert!(has("760 MPa, beyond the scale") && has("60") && !has("800"));
}

#[test]
fn the_same_report_gives_the_same_bytes() {
    let report = fixture::report();
    assert_eq!(html::page(&report), html::page(&fixture::report()));
    assert_eq!(csv::curves(&report.outcome), csv::curves(&fixture::outcome()));
}

#[test]
fn the_result_document_has_the_shape_that_scripts_rely_on() {
    let mut outcome = fixture::outcome();
    outcome.curves[0].branches[0].y[3] = f64::INFINITY;
    let document = json::document(&outcome, "abc123", "0.1.0");
    let keys: Vec<&String> = document.as_object().unwrap().keys().collect();
    assert_eq!(
        keys,
        [
            "schema",
            "forcewright",
            "mechanism",
            "title",
            "input_sha256",
            "status",
            "metrics",
            "checks",
            "curves",
            "counters",
            "sources",
            "warnings"
        ]
    );
    assert_eq!(document["schema"], 1);
    assert_eq!(document["input_sha256"], "abc123");
    assert_eq!(document["status"]["kind"], "complete");
    assert!(document["status"].get("advice").is_none());
    assert_eq!(document["metrics"]["stress_max"], serde_json::json!({ "value": 48.222_896e6, "unit": "Pa" }));
    assert!(document["metrics"]["travel_at_allowable_stress"]["value"].is_null());
    let checks = document["checks"].as_array().unwrap();
    assert_eq!((checks[1]["state"].as_str(), checks[1]["unit"].as_str()), (Some("met"), Some("Pa")));
    assert_eq!((checks[2]["state"].as_str(), checks[2]["required"].as_bool()), (Some("missed"), Some(true)));
    assert!(checks[4]["value"].is_null() && checks[4]["margin"].is_null() && checks[4]["advice"].is_string());
    let curve = &document["curves"][0];
    assert_eq!((curve["x"]["unit"].as_str(), curve["y"]["unit"].as_str()), (Some("m"), Some("N")));
    assert!(curve["branches"][0]["y"][3].is_null());
    assert_eq!(curve["branches"][0]["x"][12], 1e-3);
    assert_eq!(document["counters"]["newton_iterations"], 71);
    assert_eq!(document["sources"], serde_json::json!(["lan2010", "reissner1972"]));
    assert_eq!(document["warnings"][0]["code"], "COMP101");
    // Numbers are the shortest decimals that give the same double again.
    let text = document.to_string();
    for x in &outcome.curves[0].branches[0].x[1..] {
        assert!(text.contains(&format!("{x}")), "{x}");
    }
    assert!(serde_json::from_str::<serde_json::Value>(&text).is_ok());
}

fn rows(csv: &str) -> Vec<Vec<String>> {
    assert!(csv.ends_with("\r\n"));
    csv.trim_end().split("\r\n").map(|r| r.split(',').map(str::to_owned).collect()).collect()
}

#[test]
fn curves_over_one_abscissa_share_a_table() {
    let outcome = fixture::outcome();
    let rows = rows(&csv::curves(&outcome));
    assert_eq!(rows[0], ["branch", "displacement / mm", "force / N", "stress / MPa"]);
    assert_eq!(rows.len(), 1 + outcome.curves[0].branches[0].x.len());
    for (i, row) in rows[1..].iter().enumerate() {
        let read = |column: usize| row[column].parse::<f64>().unwrap();
        let curve = |c: usize| &outcome.curves[c];
        assert_eq!(row[0], "loading");
        assert_eq!(read(1).to_bits(), curve(0).x.display.from_si(curve(0).branches[0].x[i]).to_bits());
        assert_eq!(read(2).to_bits(), curve(0).branches[0].y[i].to_bits());
        assert_eq!(read(3).to_bits(), curve(1).y.display.from_si(curve(1).branches[0].y[i]).to_bits());
    }
}

#[test]
fn other_curves_are_written_below_each_other() {
    let mut outcome = fixture::outcome();
    outcome.curves[1].branches[0].x.truncate(2);
    outcome.curves[1].branches[0].y = vec![f64::NAN, 1e300];
    outcome.curves[1].branches[0].name = String::from("up, \"slow\"");
    outcome.curves[1].x = fixture::axis("angle", "Angle", Dimension::Angle, "rad");
    let text = csv::curves(&outcome);
    let lines: Vec<&str> = text.split("\r\n").collect();
    assert_eq!(lines[0], "curve,branch,displacement / mm,force / N,angle / rad,stress / MPa");
    assert_eq!(lines[1], "force,loading,0,0,,");
    let count = outcome.curves[0].branches[0].x.len();
    assert_eq!(lines[1 + count], "stress,\"up, \"\"slow\"\"\",,,0,");
    assert!(lines[2 + count].ends_with(",1e294"), "{}", lines[2 + count]);
    outcome.curves.clear();
    assert_eq!(csv::curves(&outcome), "branch\r\n");
}
