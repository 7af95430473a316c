//! Estimates of parameters against certified values, exact theory and repeated synthetic measurements.

mod calibrate {
    mod common;
    mod coverage;
    mod ends;
    mod nist;
    mod shapes;
    mod verdicts;
}
