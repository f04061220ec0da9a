//! Time of one catenary solve, by class of line: solving alone, no shape read.

use moorline::statics::catenary::{Bed, Section, solve};

fn main() {
    divan::main();
}

const CHAIN: Section = Section {
    length: 902.2,
    weight: 698.094,
    axial_stiffness: 384.243e6,
};

/// A class of line: its name, sections, span [m], rise [m], bed.
struct Case {
    name: &'static str,
    sections: Vec<Section>,
    span: f64,
    rise: f64,
    bed: Option<Bed>,
}

impl std::fmt::Display for Case {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name)
    }
}

fn cases() -> Vec<Case> {
    let on_bed = |friction| {
        Some(Bed {
            height: 0.0,
            friction,
        })
    };
    let one = |name, weight, axial_stiffness, span, bed| {
        let sections = vec![Section {
            weight,
            axial_stiffness,
            ..CHAIN
        }];
        Case {
            name,
            sections,
            span,
            rise: 250.0,
            bed,
        }
    };
    let three = vec![
        Section {
            length: 400.0,
            weight: 1500.0,
            axial_stiffness: 6e8,
        },
        Section {
            length: 400.0,
            weight: 90.0,
            axial_stiffness: 4e7,
        },
        Section {
            length: 102.2,
            weight: 1500.0,
            axial_stiffness: 6e8,
        },
    ];
    let wave = vec![
        Section {
            length: 400.0,
            weight: 300.0,
            axial_stiffness: 6e8,
        },
        Section {
            length: 200.0,
            weight: -250.0,
            axial_stiffness: 6e8,
        },
        Section {
            length: 302.2,
            weight: 300.0,
            axial_stiffness: 6e8,
        },
    ];
    vec![
        one("suspended", 698.094, 384.243e6, 800.0, None),
        one("touchdown", 698.094, 384.243e6, 848.67, on_bed(0.0)),
        one(
            "touchdown_friction",
            698.094,
            384.243e6,
            848.67,
            on_bed(0.5),
        ),
        one("slack", 698.094, 384.243e6, 500.0, on_bed(0.0)),
        one("over_stretched", 698.094, 384.243e6, 900.0, None),
        one("stiff", 698.094, 1e13, 800.0, None),
        one("light", 1e-11, 384.243e6, 800.0, None),
        one("buoyant", -100.0, 384.243e6, 800.0, on_bed(0.0)),
        one(
            "bed_below",
            698.094,
            384.243e6,
            700.0,
            Some(Bed {
                height: -60.0,
                friction: 0.0,
            }),
        ),
        one(
            "bed_below_friction",
            698.094,
            384.243e6,
            700.0,
            Some(Bed {
                height: -60.0,
                friction: 0.5,
            }),
        ),
        Case {
            name: "sections_suspended",
            sections: three.clone(),
            span: 820.0,
            rise: 250.0,
            bed: None,
        },
        Case {
            name: "sections_touchdown",
            sections: three,
            span: 855.0,
            rise: 250.0,
            bed: on_bed(0.5),
        },
        Case {
            name: "lazy_wave",
            sections: wave,
            span: 700.0,
            rise: 250.0,
            bed: on_bed(0.0),
        },
    ]
}

#[divan::bench(args = cases())]
fn one_solve(case: &Case) -> f64 {
    let line = solve(
        divan::black_box(&case.sections),
        case.span,
        case.rise,
        case.bed,
    );
    line.expect("the case is a line").horizontal()
}
