//! Time of one catenary solve by class of line, without reading the shape.

use moorline::statics::catenary::{FlatSeabed, Section, solve};

fn main() {
    divan::main();
}

/// Height of end B over end A [m].
const RISE: f64 = 250.0;

/// Class of line: name, sections, span [m], seabed.
struct Case {
    name: &'static str,
    sections: Vec<Section>,
    span: f64,
    seabed: Option<FlatSeabed>,
}

impl std::fmt::Display for Case {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name)
    }
}

/// Sections from their length [m], weight [N/m] and axial stiffness [N].
fn sections(rows: &[[f64; 3]]) -> Vec<Section> {
    let section = |&[length, weight, axial_stiffness]: &[f64; 3]| Section {
        length,
        weight,
        axial_stiffness,
    };
    rows.iter().map(section).collect()
}

fn seabed(height: f64, friction: f64) -> Option<FlatSeabed> {
    Some(FlatSeabed { height, friction })
}

fn cases() -> Vec<Case> {
    const EA: f64 = 384.243e6; // [N]
    let of = |name, rows: &[[f64; 3]], span, seabed| Case {
        name,
        sections: sections(rows),
        span,
        seabed,
    };
    let chain = [[902.2, 698.094, EA]];
    let stiff = [[902.2, 698.094, 1e13]];
    let light = [[902.2, 1e-11, EA]];
    let buoyant = [[902.2, -100.0, EA]];
    let three = [[400.0, 1500.0, 6e8], [400.0, 90.0, 4e7], [102.2, 1500.0, 6e8]];
    let wave = [[400.0, 300.0, 6e8], [200.0, -250.0, 6e8], [302.2, 300.0, 6e8]];
    vec![
        of("suspended", &chain, 800.0, None),
        of("touchdown", &chain, 848.67, seabed(0.0, 0.0)),
        of("touchdown_friction", &chain, 848.67, seabed(0.0, 0.5)),
        of("slack", &chain, 500.0, seabed(0.0, 0.0)),
        of("over_stretched", &chain, 900.0, None),
        of("stiff", &stiff, 800.0, None),
        of("light", &light, 800.0, None),
        of("buoyant", &buoyant, 800.0, seabed(0.0, 0.0)),
        of("seabed_below", &chain, 700.0, seabed(-60.0, 0.0)),
        of("seabed_below_friction", &chain, 700.0, seabed(-60.0, 0.5)),
        of("sections_suspended", &three, 820.0, None),
        of("sections_touchdown", &three, 855.0, seabed(0.0, 0.5)),
        of("lazy_wave", &wave, 700.0, seabed(0.0, 0.0)),
    ]
}

#[divan::bench(args = cases())]
fn one_solve(case: &Case) -> f64 {
    let sections = divan::black_box(&case.sections);
    let line = solve(sections, case.span, RISE, case.seabed);
    line.expect("the case is a line").horizontal()
}
