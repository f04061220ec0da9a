//! Scenes under construction: points and lines one per row, everything else as TOML, read like a user's scene.

#![allow(dead_code)] // each test binary uses some of it

use moorline::model::Model;
use moorline::scene::Scene;
use moorline::simulation::Simulation;

/// Scene under construction.
#[derive(Clone)]
pub struct Draft {
    keys: String,
    points: Vec<String>,
    lines: Vec<String>,
    last: Last,
}

/// Entry to which [`Draft::with`] adds keys.
#[derive(Clone, Copy)]
enum Last {
    Point,
    Line,
}

/// Starts a scene with these tables and keys as TOML, without its points and lines.
pub fn draft(keys: impl Into<String>) -> Draft {
    Draft {
        keys: keys.into(),
        points: Vec::new(),
        lines: Vec::new(),
        last: Last::Point,
    }
}

impl Draft {
    /// Adds a point of a kind at a position [m].
    pub fn point(mut self, kind: &str, name: &str, position: [f64; 3]) -> Draft {
        self.points.push(format!(
            "name = '{name}', kind = '{kind}', position = {position:?}"
        ));
        self.last = Last::Point;
        self
    }

    /// Adds a fixed point at a position [m].
    pub fn fixed(self, name: &str, position: [f64; 3]) -> Draft {
        self.point("fixed", name, position)
    }

    /// Adds a coupled point at a position [m].
    pub fn coupled(self, name: &str, position: [f64; 3]) -> Draft {
        self.point("coupled", name, position)
    }

    /// Adds a free point at a position [m].
    pub fn free(self, name: &str, position: [f64; 3]) -> Draft {
        self.point("free", name, position)
    }

    /// Adds a line of one section: its type, length [m] and number of elements, or `None` to leave it open.
    pub fn line(
        self,
        name: &str,
        ends: [&str; 2],
        line_type: &str,
        length: f64,
        elements: impl Into<Option<usize>>,
    ) -> Draft {
        self.sections(name, ends, &[(line_type, length, elements.into())])
    }

    /// Adds a line with sections: type, length [m] and number of elements of each.
    pub fn sections(mut self, name: &str, ends: [&str; 2], sections: &[(&str, f64, Option<usize>)]) -> Draft {
        let section = |(kind, length, elements): &(&str, f64, Option<usize>)| {
            let elements = elements.map_or(String::new(), |count| format!(", elements = {count}"));
            format!("{{ type = '{kind}', length = {length:?}{elements} }}")
        };
        let sections: Vec<String> = sections.iter().map(section).collect();
        let [from, to] = ends;
        let sections = sections.join(", ");
        self.lines.push(format!(
            "name = '{name}', from = '{from}', to = '{to}', sections = [{sections}]"
        ));
        self.last = Last::Line;
        self
    }

    /// Adds keys, such as `mass = 1.0, volume = 2.0`, to the point or line added last.
    pub fn with(mut self, keys: &str) -> Draft {
        let entries = match self.last {
            Last::Point => &mut self.points,
            Last::Line => &mut self.lines,
        };
        if !keys.is_empty() {
            let entry = entries.last_mut().expect("a point or a line to add keys to");
            *entry += &format!(", {keys}");
        }
        self
    }

    /// Adds tables and keys of the scene.
    pub fn and(mut self, keys: &str) -> Draft {
        self.keys += &format!("\n{keys}");
        self
    }

    /// Returns the scene as TOML.
    pub fn text(&self) -> String {
        let array = |name: &str, entries: &[String]| {
            let entries: Vec<String> = entries
                .iter()
                .map(|entry| format!("  {{ {entry} }},\n"))
                .collect();
            format!("{name} = [\n{}]\n", entries.concat())
        };
        format!(
            "{}{}{}\n",
            array("points", &self.points),
            array("lines", &self.lines),
            self.keys
        )
    }

    /// Returns the scene, read from its TOML.
    pub fn scene(&self) -> Scene {
        Scene::from_toml(&self.text()).unwrap_or_else(|error| panic!("{error}\n{}", self.text()))
    }

    /// Returns the model of the scene.
    pub fn model(&self) -> Model {
        Model::new(&self.scene()).unwrap()
    }

    /// Returns a simulation of the scene at its start.
    pub fn start(&self) -> Simulation {
        Simulation::new(&self.scene()).unwrap()
    }
}
