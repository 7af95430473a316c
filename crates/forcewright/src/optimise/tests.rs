use super::*;
use forcewright_study::nlp::Stop;

/// What `tighten` does where one check alone is missed by a part of the scale of the limit of that name.
fn tightened_by(check: &str, limit: &str, part: f64) -> (Task, Reserve) {
    let text = crate::gallery::find("optimise-lan-box").expect("in the gallery").text;
    let loaded = Loaded::from_text("box.toml", text, &Choices::default()).map_err(|e| e.render(false)).expect("understood");
    let (task, _) = loaded.task().map_err(|e| e.render(false)).expect("a task");
    let limit = task.limits.iter().find(|l| l.name == limit).expect("a limit").clone();
    let mut report = loaded.solve("box.toml", "", &mut |_| true);
    for own in &mut report.outcome.checks {
        own.state = if own.name == check { CheckState::Missed } else { CheckState::Met };
        own.limit = Some(limit.lower);
        own.value = Some(limit.lower - part * limit.scale);
    }
    let run = Run {
        start: Vec::new(),
        x: Vec::new(),
        goal: -0.5,
        violation: 0.0,
        kkt_residual: 0.0,
        stop: Stop::Settled,
        history: Vec::new(),
        iterations: 0,
        evaluations: 0,
        active: Vec::new(),
    };
    let found = Candidate { goal: run.goal, run, reserve: Reserve::default(), text: String::new(), report };
    let mut reserve = Reserve::default();
    tighten(&mut reserve, &task, &found, 1.0);
    (task, reserve)
}

/// However far a stiffness is missed, its own limit moves; a stretch that falls far short is the doing of its band.
#[test]
fn only_a_stretch_that_falls_apart_narrows_its_band() {
    let part = 20.0 * BEYOND;
    let (task, reserve) = tightened_by("stiffness", "stiffness", part);
    let limit = task.limits.iter().find(|l| l.name == "stiffness").expect("a limit");
    let wanted = (part + LEAST_MOVE) * limit.scale;
    assert!(limit.values.clone().all(|at| (reserve.limits[at] - wanted).abs() < 1e-9 * wanted));
    assert!(reserve.bands.iter().all(|b| b.abs() < f64::MIN_POSITIVE));
    let (_, reserve) = tightened_by("travel", "travel", part);
    assert!(reserve.limits.iter().all(|l| l.abs() < f64::MIN_POSITIVE) && reserve.bands.iter().all(|b| *b >= NARROWER));
}
