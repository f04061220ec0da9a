//! `report.html`: one self-contained page about a run.
//!
//! A summary, the static equilibrium compared with the closed-form catenary, tension and laid length in time, the figures as inline
//! SVG, and a description of the model.

use quick_xml::escape::escape;

use super::record::{LineRecord, Record, StaticLine};

/// CSS style of pages.
pub(super) const STYLE: &str = "
body { font: 16px/1.5 sans-serif; color: #222; max-width: 60rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.5rem; } h2 { font-size: 1.15rem; margin-top: 2rem; }
table { border-collapse: collapse; } caption { text-align: left; color: #555; padding-bottom: .3rem; }
th, td { padding: .2rem .8rem .2rem 0; border-bottom: 1px solid #ddd; text-align: right; }
th:first-child, td:first-child { text-align: left; } td { font-variant-numeric: tabular-nums; }
.wide { overflow-x: auto; } figure { margin: 1rem 0; } svg { max-width: 100%; height: auto; }
pre { white-space: pre-wrap; background: #f6f6f6; padding: .8rem; font-size: .85rem; }
";

/// Significant digits of a number in a table [-].
const DIGITS: usize = 6;

/// Page of a run with its figures. `words` is the description of the scene's model as printed by `moorline check`.
pub fn html(record: &Record, figures: &[(&str, String)], words: &str) -> String {
    let title = match record.title.as_str() {
        "" => "moorline run",
        title => title,
    };
    let title = escape(title);
    let figures = shown(figures.iter().map(|(_, svg)| svg));
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n<h1>{title}</h1>\n{}\
         <h2>Static equilibrium</h2>\n{}<h2>In time</h2>\n{}<h2>Figures</h2>\n{figures}\
         <h2>What is modelled</h2>\n<pre>{}</pre>\n\
         <p>moorline {}. SI units; z up, z = 0 at still water; forces are those of the mooring on the vessel.</p>\n\
         </body>\n</html>\n",
        cost(record),
        statics(record),
        history(record),
        escape(words.trim_end()),
        env!("CARGO_PKG_VERSION"),
    )
}

/// Cost of the run, in a sentence.
fn cost(record: &Record) -> String {
    let counters = &record.course.counters;
    let speed = counters.real_time_factor().map_or(String::new(), |factor| {
        format!(
            " in {} s: {} times real time",
            rounded(counters.wall.as_secs_f64(), 3),
            rounded(factor, 3)
        )
    });
    format!(
        "<p>{} s simulated with {} internal steps{speed}.</p>\n",
        rounded(counters.simulated, DIGITS),
        counters.substeps
    )
}

/// Discretised equilibrium compared with the closed form.
fn statics(record: &Record) -> String {
    type Figure = fn(&StaticLine) -> f64;
    let figures: [(&str, Figure); 4] = [
        ("tension at end B [N]", |line| line.tension_b),
        ("horizontal force at end B [N]", |line| line.horizontal),
        ("sag below the chord [m]", |line| line.sag),
        ("length on the seabed [m]", |line| line.laid_length),
    ];
    let rows: Vec<Vec<String>> = record
        .lines
        .iter()
        .flat_map(|line| {
            figures.map(|(name, figure)| {
                let closed = line.catenary.as_ref().map(|c| figure(&c.figures));
                let solved = line.equilibrium.as_ref().map(figure);
                let said =
                    |value: Option<f64>| value.map_or("none".to_string(), |value| rounded(value, DIGITS));
                let both = solved.zip(closed);
                vec![
                    format!("{}: {name}", line.name),
                    said(solved),
                    said(closed),
                    both.map_or(String::new(), |(solved, closed)| difference(solved, closed)),
                ]
            })
        })
        .collect();
    table(
        "The discretised lines at rest in the reference configuration, with the closed-form elastic catenary.",
        &["", "equilibrium", "catenary", "difference"],
        &rows,
    )
}

/// Ranges of the lines' histories.
fn history(record: &Record) -> String {
    let of_line = |line: &LineRecord| {
        [
            ("tension_b", "tension at end B [N]"),
            ("tension_a", "tension at end A [N]"),
            ("tension_max", "greatest tension [N]"),
            ("sag", "sag [m]"),
            ("laid_length", "length on the seabed [m]"),
        ]
        .into_iter()
        .filter_map(|(stem, name)| {
            let range = record.range(&format!("{}.{stem}", line.name))?;
            Some(vec![
                format!("{}: {name}", line.name),
                rounded(range.min, DIGITS),
                rounded(range.mean, DIGITS),
                rounded(range.max, DIGITS),
            ])
        })
        .collect::<Vec<_>>()
    };
    let rows: Vec<Vec<String>> = record.lines.iter().flat_map(of_line).collect();
    table(
        "Over the whole run; the mean is over time.",
        &["", "least", "mean", "greatest"],
        &rows,
    )
}

/// Table with a row of headings; an empty caption is omitted.
pub(super) fn table(caption: &str, head: &[&str], rows: &[Vec<String>]) -> String {
    let row = |tag: &str, cells: &mut dyn Iterator<Item = &str>| {
        let cells: String = cells
            .map(|cell| format!("<{tag}>{}</{tag}>", escape(cell)))
            .collect();
        format!("<tr>{cells}</tr>\n")
    };
    let caption = match caption {
        "" => String::new(),
        caption => format!("<caption>{}</caption>\n", escape(caption)),
    };
    let head = row("th", &mut head.iter().copied());
    let rows = rows
        .iter()
        .map(|cells| row("td", &mut cells.iter().map(String::as_str)));
    let rows: String = rows.collect();
    format!("<div class=\"wide\"><table>\n{caption}{head}{rows}</table></div>\n")
}

/// Figures as HTML elements of a page.
pub(super) fn shown<'s>(figures: impl Iterator<Item = &'s String>) -> String {
    figures.map(|svg| format!("<figure>\n{svg}</figure>\n")).collect()
}

/// Difference in per cent of the reference, or in the value's unit if the reference is 0.
pub fn difference(value: f64, reference: f64) -> String {
    if value == reference {
        "0".to_string()
    } else if reference == 0.0 {
        format!("{:+.2e}", value - reference)
    } else {
        format!("{:+.4} %", 100.0 * (value - reference) / reference.abs())
    }
}

/// Text of a number with `digits` significant digits.
pub fn rounded(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}").replace("-0", "0");
    }
    let before = value.abs().log10().floor() as i32 + 1;
    if !(-3..=9).contains(&before) {
        return format!("{value:.*e}", digits - 1);
    }
    let behind = (digits as i32 - before).max(0) as usize;
    let text = format!("{value:.behind$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_string()
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::super::{figures, sample};
    use super::*;

    #[test]
    fn the_page_holds_everything_and_asks_for_nothing() {
        let record = sample::record();
        let page = html(&record, &figures::all(&record), "water: 1025 kg/m³ & no waves");
        for part in [
            "911120",
            "911089",
            "+0.0034 %",
            "1500 times real time",
            "1025 kg/m³ &amp; no waves",
        ] {
            assert!(page.contains(part), "{part}");
        }
        assert_eq!(page.matches("<svg ").count(), 3);
        for reference in ["src=", "href=", "@import", "url("] {
            assert!(!page.contains(reference), "{reference}");
        }
    }

    #[test]
    fn a_title_with_markup_stays_text() {
        let mut record = sample::record();
        record.title = "<script>alert(1)</script>".to_string();
        record.lines[0].name = "<b>".to_string();
        let page = html(&record, &figures::all(&record), "");
        assert!(!page.contains("<script>") && !page.contains("<b>"));
    }

    #[test]
    fn a_rounded_number_keeps_its_digits_and_no_idle_ones() {
        assert_eq!(rounded(911_089.46, 6), "911089");
        assert_eq!(rounded(0.717_777_465_4, 6), "0.717777");
        assert_eq!(rounded(60.0, 6), "60");
        assert_eq!(rounded(1e-7, 3), "1.00e-7");
        assert_eq!(rounded(-0.0, 3), "0");
        assert_eq!(rounded(100.0, 3), "100");
    }

    #[test]
    fn a_difference_from_nothing_is_not_in_per_cent() {
        assert_eq!(difference(101.0, 100.0), "+1.0000 %");
        assert_eq!(difference(0.5, 0.0), "+5.00e-1");
        assert_eq!(difference(0.0, 0.0), "0");
    }
}
