//! Soundings from a file: a table in CSV, or a bathymetry file of MoorDyn-F and MoorPy, or of MoorDyn-C.
//!
//! ```text
//! CSV:  y/x, x₁, x₂, …     MoorDyn-F:  --- MoorPy Bathymetry Input File ---     MoorDyn-C:  3 2
//!       y₁,  d₁₁, d₁₂, …               nGridX 3                                             x₁ x₂ x₃
//!       y₂,  d₂₁, d₂₂, …               nGridY 2                                             y₁ y₂
//!                                      x₁  x₂  x₃                                           x₁ y₁ z₁₁
//!                                      y₁  d₁₁ d₁₂ d₁₃                                      x₂ y₁ z₁₂
//!                                      y₂  d₂₁ d₂₂ d₂₃                                      … one row for every x and y, in any order
//! ```
//!
//! The first two are the same table of depths, positive downwards [m]. A unit in brackets in the top left cell of the CSV, such as `y/x [km]`,
//! applies to all its numbers; other text in this cell is ignored. With semicolons between the columns, numbers may have decimal commas. The
//! third lists heights of the seabed, negative below the water [m]. The first row identifies the format: a row of dashes the second, two whole
//! numbers the third. Blank lines and lines that begin with # are skipped.
//! Source of the second: documentation of MoorDyn, "Seafloor/Bathymetry File", and the reader of MoorPy; of the third: MoorDyn-C,
//! `source/Seafloor.cpp`, which moves a row off the listed x and y to the next lower ones and takes a missing row as a height of 0: here both
//! are refused.

use std::path::Path;

use super::columns::Separator;
use super::units::{self, Quantity};
use super::{DepthGrid, input_file};

/// Names of the grid sizes in a file of MoorDyn-F, in capitals.
const SIZES: [&str; 2] = ["NGRIDX", "NGRIDY"];

/// Number and words of a line of the file.
type Row = (usize, Vec<String>);

/// Reads the soundings in a file.
///
/// # Errors
/// The file and line of the mistake, and its correction.
pub(super) fn read(path: &Path) -> Result<DepthGrid, String> {
    let name = path.display();
    let bytes = input_file::read_table(path, "a file of soundings")?;
    let text = String::from_utf8(bytes).map_err(|error| format!("{name} cannot be read as text: {error}"))?;
    let grid = parse(&text).and_then(below_water);
    grid.map_err(|problem| format!("{name}{problem}"))
}

/// Refuses soundings above z = 0.
fn below_water(grid: DepthGrid) -> Result<DepthGrid, String> {
    for (y, row) in grid.y.iter().zip(&grid.depth) {
        if let Some((x, depth)) = grid.x.iter().zip(row).find(|(_, depth)| **depth < 0.0) {
            return Err(format!(
                ": the depth at x = {x} m, y = {y} m is {depth} m, above the water: depths count downwards from z = 0, heights upwards"
            ));
        }
    }
    Ok(grid)
}

/// Returns the soundings in a text. Messages begin with a comma and the line number, or with a colon.
fn parse(text: &str) -> Result<DepthGrid, String> {
    let rows: Vec<Row> = text
        .trim_start_matches('\u{feff}')
        .lines()
        .enumerate()
        .map(|(i, line)| (i + 1, line.trim()))
        .filter(|(_, line)| !line.is_empty() && !line.starts_with('#'))
        .map(|(number, line)| (number, words(line)))
        .collect();
    let first = rows.first().ok_or(": no soundings in it")?;
    if first.1[0].starts_with("---") {
        moordyn_table(&rows)
    } else if let Some(sizes) = counts(&first.1) {
        moordyn_c_heights(&rows, sizes)
    } else {
        table(&rows[0], &rows[1..], 1)
    }
}

fn words(line: &str) -> Vec<String> {
    let separator = Separator::of(line);
    let decimal = |word: &str| match separator.number(word) {
        Ok(_) if separator == Separator::Semicolon => word.replace(',', "."),
        _ => word.to_string(),
    };
    separator.cells(line).into_iter().map(decimal).collect()
}

/// Unit in the corner of a table [m]; 1 if there is none.
fn corner_unit(corner: &str) -> Result<f64, String> {
    let mut axes = corner
        .split(['/', '\\'])
        .map(|name| name.trim_start().to_lowercase());
    if let (Some(down), Some(right)) = (axes.next(), axes.next())
        && down.starts_with('x')
        && right.starts_with('y')
    {
        return Err(format!(
            "{corner:?} has x downwards: a table of soundings has y downwards and x to the right"
        ));
    }
    let mut factor = None;
    for unit in units::bracketed(corner) {
        let own = units::factor(unit, Quantity::Length)?;
        if factor.is_some_and(|other| other != own) {
            return Err(format!(
                "{corner:?} has several units: one for all numbers would be right"
            ));
        }
        factor = Some(own);
    }
    Ok(factor.unwrap_or(1.0))
}

/// Reads the sizes of the grid, then the table below them.
fn moordyn_table(rows: &[Row]) -> Result<DepthGrid, String> {
    let mut sizes = [0; 2];
    for (size, (row, key)) in sizes.iter_mut().zip(rows[1..].iter().zip(SIZES)) {
        let is_size = |word: &String| word.to_uppercase() == key;
        let number = row.1.iter().find_map(|word| word.parse::<usize>().ok());
        *size = number
            .filter(|_| row.1.iter().any(is_size))
            .ok_or_else(|| format!(", line {}: expected `{key}` and a whole number", row.0))?;
    }
    let Some(header) = rows.get(3) else {
        return Err(": no row of x below nGridY".into());
    };
    let grid = table(header, &rows[4..], 0)?;
    if [grid.x.len(), grid.y.len()] != sizes {
        return Err(format!(
            ": nGridX and nGridY say {} by {}, and {} by {} soundings are there",
            sizes[0],
            sizes[1],
            grid.x.len(),
            grid.y.len()
        ));
    }
    Ok(grid)
}

/// Numbers of x and of y, if the first row consists of two whole numbers.
fn counts(words: &[String]) -> Option<[usize; 2]> {
    let [x, y] = words else { return None };
    Some([x.parse().ok()?, y.parse().ok()?])
}

/// Reads the numbers of x and of y, then both lists, then a row of x, y and height for every grid point.
fn moordyn_c_heights(rows: &[Row], sizes: [usize; 2]) -> Result<DepthGrid, String> {
    let list = |index: usize, axis: &str| -> Result<Vec<f64>, String> {
        let wanted = sizes[index];
        let (line, words) = rows
            .get(1 + index)
            .ok_or_else(|| format!(": no row of {wanted} {axis} below the two counts"))?;
        if words.len() != wanted {
            return Err(format!(
                ", line {line}: expected {wanted} {axis}, as many as line {} says, found {} numbers",
                rows[0].0,
                words.len()
            ));
        }
        numbers(*line, words, 1.0)
    };
    let (x, y) = (list(0, "x")?, list(1, "y")?);
    if x.is_empty() || y.is_empty() {
        return Err(": no soundings in it".into());
    }
    let mut heights = vec![vec![None; x.len()]; y.len()];
    for (line, words) in rows.iter().skip(3) {
        let [place_x, place_y, height] = numbers(*line, words, 1.0)?[..] else {
            let found = words.len();
            return Err(format!(
                ", line {line}: expected x, y and the height z of the seabed, found {found} numbers"
            ));
        };
        let index = |list: &[f64], place: f64, axis: &str| {
            let found = list.iter().position(|known| *known == place);
            found.ok_or_else(|| format!(", line {line}: {axis} = {place} m is not in the list of {axis}"))
        };
        let cell = &mut heights[index(&y, place_y, "y")?][index(&x, place_x, "x")?];
        if cell.replace(height).is_some() {
            return Err(format!(
                ", line {line}: a second height at x = {place_x} m, y = {place_y} m"
            ));
        }
    }
    if heights.iter().flatten().flatten().all(|height| *height > 0.0) && rows.len() > 3 {
        return Err(
            ": every height is above the water: z is that of the seabed, negative below z = 0".into(),
        );
    }
    let mut depth = Vec::with_capacity(y.len());
    for (row, y) in heights.iter().zip(&y) {
        let cell = |(height, x): (&Option<f64>, &f64)| {
            let missing = || format!(": no height at x = {x} m, y = {y} m");
            height.map(|height| -height).ok_or_else(missing)
        };
        depth.push(row.iter().zip(&x).map(cell).collect::<Result<_, _>>()?);
    }
    Ok(DepthGrid { x, y, depth })
}

/// Words of a line as finite numbers [m]; `factor` is their unit in metres.
fn numbers(line: usize, words: &[String], factor: f64) -> Result<Vec<f64>, String> {
    let number = |word: &String| match word.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value * factor),
        _ => Err(format!(
            ", line {line}: expected a finite number [m], found {word:?}"
        )),
    };
    words.iter().map(number).collect()
}

/// Grid from a row of x after `skipped` words, and rows of y with its depths.
fn table(header: &Row, rows: &[Row], skipped: usize) -> Result<DepthGrid, String> {
    let corner = header.1[..skipped].last(); // none if nothing is skipped
    let factor = corner.map_or(Ok(1.0), |word| corner_unit(word));
    let factor = factor.map_err(|problem| format!(", line {}: {problem}", header.0))?;
    let x = numbers(header.0, &header.1[skipped..], factor)?;
    let (mut y, mut depth) = (Vec::new(), Vec::new());
    for (line, words) in rows {
        let row = numbers(*line, words, factor)?;
        if row.len() != x.len() + 1 {
            return Err(format!(
                ", line {line}: expected y and {} depths, found {} numbers",
                x.len(),
                row.len()
            ));
        }
        y.push(row[0]);
        depth.push(row[1..].to_vec());
    }
    if x.is_empty() || y.is_empty() {
        return Err(": no soundings in it".into());
    }
    Ok(DepthGrid { x, y, depth })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::assert_answers;

    fn grid() -> DepthGrid {
        DepthGrid {
            x: vec![-100.0, 0.0, 250.0],
            y: vec![-50.0, 50.0],
            depth: vec![vec![90.0, 95.0, 100.0], vec![91.0, 96.0, 104.5]],
        }
    }

    #[test]
    fn a_table_in_csv_and_files_of_both_moordyns_hold_the_same_soundings() {
        let csv = "# survey\ny/x, -100, 0, 250\n-50, 90, 95, 100\n\n50, 91, 96, 104.5\n";
        let moordyn = "--- MoorPy Bathymetry Input File v1.0 ---\nnGridX 3\nnGridY 2\n-100 0 250\n\
                       -50 90 95 100\n50 91 96 104.5\n";
        assert_eq!(parse(csv), Ok(grid()));
        assert_eq!(parse(moordyn), Ok(grid()));
        let moordyn_c = "3 2\n-100 0 250\n-50.0 50.0\n-100 -50 -90\n0 -50 -95\n250 -50 -100\n\
                         250 50 -104.5\n-100 50 -91\n0 50 -96\n";
        assert_eq!(parse(moordyn_c), Ok(grid()));
    }

    #[test]
    fn a_unit_in_the_corner_is_that_of_all_numbers_and_decimals_may_have_commas() {
        for text in [
            "y/x [km], -0.1, 0, 0.25\n-0.05, 0.09, 0.095, 0.1\n0.05, 0.091, 0.096, 0.1045\n",
            "y [m]/x [m]; -100; 0; 250\n-50; 90,0; 95; 100\n50; 91; 96; 104,5\n",
        ] {
            let found = parse(text).unwrap();
            let of = |grid: &DepthGrid| [grid.x.clone(), grid.y.clone(), grid.depth.concat()].concat();
            for (found, wanted) in of(&found).iter().zip(of(&grid())) {
                assert!((found - wanted).abs() <= 1e-13 * wanted.abs(), "{text}");
            }
        }
        let unknown = parse("y/x [mile], 0, 1\n0, 5, 6\n1, 5, 6\n").unwrap_err();
        assert!(
            unknown.starts_with(", line 1: unknown unit \"mile\""),
            "{unknown}"
        );
    }

    #[test]
    fn what_is_wrong_is_said_with_its_line() {
        assert_eq!(parse(""), Err(": no soundings in it".to_string()));
        assert_answers(
            "",
            include_str!("../../tests/scene/bathymetry_files.txt"),
            |text| parse(text).err().unwrap_or_default() + "\n",
        );
    }
}
