//! Deck converted to a scene, with objects and degrees of freedom in the deck's order.

use std::path::{Path, PathBuf};

use moorline::model::Body;
use moorline::scene::{self, LoadError, PointKind, Scene};
use moorline_decks::{BodyRow, Carrier, Lists, load, moordyn_lists};

use crate::failure::{Code, Failure, Outcome};
use crate::settings::Settings;

/// Name that the reader gives to the vessel of OpenFAST; this interface has coupled points instead.
const VESSEL: &str = "vessel";

/// Number of header lines of a tension table that MoorDyn skips [-].
const HEADS: usize = 3;

/// Object moved by the host.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Coupled {
    /// Point or vessel of the scene; `None` for a body that carries nothing.
    pub body: Option<Body>,
    /// Index of its first degree of freedom.
    pub first: usize,
    /// Number of its degrees of freedom [-]: 3 or 6.
    pub size: usize,
}

/// Deck as read from its file.
#[derive(Debug)]
pub struct Deck {
    /// Scene with the laws selected by the settings.
    pub scene: Scene,
    /// Objects in the deck's order.
    pub lists: Lists,
    /// Objects moved by the host, in the order of their degrees of freedom.
    pub coupled: Vec<Coupled>,
    /// Indices of the points in the scene, by row.
    points: Vec<Option<usize>>,
    /// Path of the deck without its extension; the paths of output files begin with it.
    pub stem: PathBuf,
    /// Remarks from reading the deck.
    pub remarks: Vec<String>,
}

impl Deck {
    /// Reads a deck.
    ///
    /// # Errors
    /// The file cannot be read, has mistakes, or requests something that is not modelled.
    pub fn read(path: &Path, settings: &Settings) -> Outcome<Deck> {
        let loaded = load(path).map_err(|error| refusal(&error))?;
        if loaded.format.contains("MAP++") || loaded.format == moorline::scene::TOML {
            let message = format!(
                "{} is a {} file: this interface reads decks of MoorDyn",
                path.display(),
                loaded.format
            );
            return Err(Failure::new(Code::InvalidInputFile, message));
        }
        let lists = moordyn_lists(&loaded.text);
        let mut scene = loaded.scene;
        check(&lists, &scene)?;
        for point in &mut scene.points {
            if point.on.as_deref() == Some(VESSEL) {
                point.on = None;
            }
        }
        scene.vessels.retain(|vessel| vessel.name != VESSEL);
        settings.apply(&mut scene);
        let mut remarks: Vec<String> = loaded.notes.iter().map(ToString::to_string).collect();
        remarks.extend(other_laws(&scene).into_iter().map(String::from));
        remarks.extend(rows_of_tables(&scene, path));
        Ok(Deck {
            coupled: coupled(&lists, &scene),
            points: points(&lists, &scene),
            stem: path.with_extension(""),
            remarks,
            lists,
            scene,
        })
    }

    /// Returns the number of coupled degrees of freedom.
    pub fn degrees_of_freedom(&self) -> usize {
        self.coupled.iter().map(|coupled| coupled.size).sum()
    }

    /// Returns the index in the scene of the point in a row of the deck, counted from 0.
    pub fn point(&self, row: usize) -> Option<usize> {
        *self.points.get(row)?
    }

    /// Returns the coupled object of the body in a row, counted from 0.
    pub fn coupled_body(&self, row: usize) -> Option<&Coupled> {
        let before = self.lists.bodies[..row.min(self.lists.bodies.len())].iter();
        let moved = |body: &&BodyRow| body.carrier == Carrier::Host;
        let is_moved = self.lists.bodies.get(row).filter(moved).is_some();
        is_moved.then(|| &self.coupled[before.filter(moved).count()])
    }
}

/// Refuses a deck whose objects a host would number differently from the scene.
fn check(lists: &Lists, scene: &Scene) -> Outcome {
    if lists.is_of_farm {
        return Err(Failure::missing(
            "points on turbines belong to the farm of OpenFAST: this interface has Coupled points and bodies",
        ));
    }
    let mut on_vessel = scene
        .points
        .iter()
        .filter(|point| point.on.as_deref() == Some(VESSEL));
    if let Some(rod) = on_vessel.find(|point| !point.name.starts_with("point")) {
        let message = format!(
            "{} belongs to a rod that the host moves by itself, which is not modelled: put the rod on a coupled body",
            rod.name
        );
        return Err(Failure::missing(message));
    }
    Ok(())
}

/// Indices in the scene of the points of a deck, by row.
fn points(lists: &Lists, scene: &Scene) -> Vec<Option<usize>> {
    let index = |number: &usize| {
        let name = format!("point{number}");
        scene.points.iter().position(|point| point.name == name)
    };
    lists.points.iter().map(index).collect()
}

fn coupled(lists: &Lists, scene: &Scene) -> Vec<Coupled> {
    let vessel = |number: usize| {
        let name = format!("body{number}");
        let index = scene.vessels.iter().position(|vessel| vessel.name == name);
        (index.map(Body::Vessel), 6)
    };
    let moved = lists.bodies.iter().filter(|body| body.carrier == Carrier::Host);
    let bodies = moved.map(|body| vessel(body.number));
    let points = scene.points.iter().enumerate();
    let points = points.filter(|(_, point)| point.kind == PointKind::Coupled && point.on.is_none());
    let mut first = 0;
    let place = |(body, size)| {
        let coupled = Coupled { body, first, size };
        first += size;
        coupled
    };
    let points = points.map(|(index, _)| (Some(Body::Point(index)), 3));
    bodies.chain(points).map(place).collect()
}

/// Remarks on laws of a scene that differ from MoorDyn's, regardless of the settings.
fn other_laws(scene: &Scene) -> Vec<&'static str> {
    let seabed = scene.seabed.as_ref();
    let viscoelastic = scene
        .line_types
        .values()
        .any(|kind| kind.dynamic_stiffness.is_some());
    let displaces = |point: &scene::Point| point.volume.is_some_and(|volume| volume > 0.0);
    let laws = [
        (
            scene.water.as_ref().is_some_and(|water| water.waves.is_some())
                && scene.points.iter().any(displaces),
            "waves push a point that has a volume by the acceleration of the water; in MoorDyn they do not",
        ),
        (
            seabed.is_some_and(|seabed| !seabed.is_level()),
            "a sloping seabed pushes along its normal; MoorDyn-C's pushes vertically",
        ),
        (
            seabed.is_some_and(|seabed| seabed.friction.acts()),
            "friction during a run holds a node up to its limit; in MoorDyn it grows with the velocity up to the limit, and lines drift slowly",
        ),
        (
            seabed.is_some_and(|seabed| seabed.grid.is_some()),
            "the seabed is a smooth surface through the soundings; MoorDyn's has edges there",
        ),
        (
            viscoelastic,
            "a viscoelastic line carries no compression; in MoorDyn it does",
        ),
    ];
    laws.into_iter().filter(|law| law.0).map(|law| law.1).collect()
}

/// Remarks on tension tables that MoorDyn reads differently, since it skips the first three lines.
fn rows_of_tables(scene: &Scene, deck: &Path) -> Vec<String> {
    let tables = scene
        .line_types
        .values()
        .filter_map(|kind| kind.tension_strain.as_ref());
    let files = tables.filter_map(|table| table.file.as_deref());
    let remark = |file: &str| {
        let text = std::fs::read_to_string(deck.parent()?.join(file)).ok()?;
        let is_row = |line: &str| {
            line.split_whitespace()
                .next()
                .is_some_and(|word| word.parse::<f64>().is_ok())
        };
        let heads = text.lines().take_while(|line| !is_row(line)).count();
        (heads != HEADS).then(|| {
            format!("{file}: all rows are read; MoorDyn skips the first {HEADS} lines, but {heads} lines precede the first row here")
        })
    };
    files.filter_map(remark).collect()
}

/// Failure for a deck that cannot be used, with all its mistakes.
fn refusal(error: &LoadError) -> Failure {
    let mut message = error.to_string();
    if let LoadError::Scene { mistakes, .. } = error {
        let others = mistakes.iter().map(|mistake| format!("\n  {mistake}"));
        let list: String = others.collect();
        if !message.contains(list.trim()) {
            message.push_str(&list);
        }
    }
    Failure::new(Code::InvalidInputFile, message)
}
