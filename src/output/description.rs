//! modelDescription.xml for FMI 2.0 and 3.0, written from the interface table.
//!
//! Sources: FMI 2.0.4 section 2.2 and 4.3.1, FMI 3.0.2 section 2.4 and 4.4.1. Numbers are in the shortest form that reads
//! back to the same bits; nothing depends on locale, clock or machine. Value references are positions, since
//! OMSimulator takes the dependency references of FMI 3.0 for positions.

use std::io;

use sha2::{Digest, Sha256};

use super::fmi::FmiVersion;
use super::package::Stamp;
use super::xml::{Xml, document, empty, number, texts, within};
use crate::interface::{Causality, Interface, Kind, Layout, Unit, Variability, Variable};
use crate::model::Model;
use crate::scene::{Profile, Scene, SceneError};

/// Prefix of the name of every library.
const IDENTIFIER: &str = "moorline";
/// Greatest length of the title in the name of the library [-].
const TITLE_MAX: usize = 40;

/// Version of this program, part of the token.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Categories of log messages with their meaning; the FMU uses no other.
pub const LOG_CATEGORIES: [(&str, &str); 4] = [
    ("logEvents", "what was chosen and why"),
    ("logStatusWarning", "a call was carried out with a reservation"),
    (
        "logStatusError",
        "a call was refused or failed; the state is as before",
    ),
    (
        "logStatusFatal",
        "an internal fault; the instance can only be freed",
    ),
];

/// Content of an FMU of a scene, except the library.
#[derive(Debug, Clone)]
pub struct Description {
    /// The table of variables.
    pub interface: Interface,
    /// Text of modelDescription.xml.
    pub xml: String,
    /// Name of the model: the title of the scene.
    pub model_name: String,
    /// Name of the library in the FMU, without extension.
    pub model_identifier: String,
    /// The instantiation token: hash of the description, the scene's text and the program's version.
    pub token: String,
}

impl Description {
    /// Describes a scene, given as the text in the FMU and as read from this text.
    ///
    /// # Errors
    /// No model can be built from the scene, or names clash.
    pub fn new(text: &str, scene: &Scene, version: FmiVersion) -> Result<Description, SceneError> {
        Description::stamped(text, scene, version, &Stamp::default())
    }

    /// Describes a scene with author and date; the token is that of [`Description::new`].
    ///
    /// # Errors
    /// As [`Description::new`].
    pub fn stamped(
        text: &str,
        scene: &Scene,
        version: FmiVersion,
        stamp: &Stamp,
    ) -> Result<Description, SceneError> {
        let layout = match (version, scene.output.profile) {
            (FmiVersion::Two, _) | (_, Profile::Scalar) => Layout::Scalars,
            (FmiVersion::Three, _) => Layout::Arrays,
        };
        let model = Model::new(scene)?;
        let interface = Interface::new(scene, &model, layout)?;
        let token = token(&write(scene, &interface, version, ("", &Stamp::default())), text);
        let xml = write(scene, &interface, version, (&token, stamp));
        Ok(Description {
            interface,
            xml,
            model_name: model_name(scene),
            model_identifier: model_identifier(scene),
            token,
        })
    }
}

/// SHA-256 in hexadecimal; every part is hashed with its length.
fn token(xml: &str, scene: &str) -> String {
    let mut hash = Sha256::new();
    for part in [VERSION, xml, scene] {
        hash.update((part.len() as u64).to_le_bytes());
        hash.update(part);
    }
    hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

fn write(scene: &Scene, interface: &Interface, version: FmiVersion, signed: (&str, &Stamp)) -> String {
    document(|xml| write_root(xml, scene, interface, version, signed))
}

fn write_root(
    xml: &mut Xml,
    scene: &Scene,
    interface: &Interface,
    version: FmiVersion,
    (token, stamp): (&str, &Stamp),
) -> io::Result<()> {
    let (name, version_text) = (model_name(scene), version.to_string());
    let generation_tool = format!("moorline {VERSION}");
    let naming = if interface.variables().iter().all(|v| is_structured(&v.name)) {
        "structured"
    } else {
        "flat"
    };
    let token_key = match version {
        FmiVersion::Two => "guid",
        FmiVersion::Three => "instantiationToken",
    };
    let mut root = vec![
        ("fmiVersion", version_text.as_str()),
        ("modelName", &name),
        (token_key, token),
        (
            "description",
            "Mooring lines: displacements of the fairleads in, forces of the mooring out. \
                 SI units, global axes, z up, z = 0 at still water.",
        ),
        ("version", VERSION),
        ("license", "MIT OR Apache-2.0"),
        ("generationTool", &generation_tool),
        ("variableNamingConvention", naming),
    ];
    root.extend(stamp.author.as_deref().map(|author| ("author", author)));
    root.extend(stamp.date.as_deref().map(|date| ("generationDateAndTime", date)));
    let experiment = [
        ("startTime", "0.0".to_string()),
        ("stopTime", number(scene.output.duration)),
        ("tolerance", number(scene.solver.tolerance)),
        ("stepSize", number(scene.output.interval)),
    ];
    within(xml, "fmiModelDescription", &root, |xml| {
        write_co_simulation(xml, scene, version)?;
        write_units(xml, interface, version)?;
        within(xml, "LogCategories", &[], |xml| {
            LOG_CATEGORIES.iter().try_for_each(|(name, description)| {
                empty(xml, "Category", &[("name", name), ("description", description)])
            })
        })?;
        empty(xml, "DefaultExperiment", &texts(&experiment))?;
        within(xml, "ModelVariables", &[], |xml| {
            write_variables(xml, interface, version)
        })?;
        within(xml, "ModelStructure", &[], |xml| {
            write_structure(xml, interface, version, scene.output.derivatives)
        })
    })
}

/// Title of the scene, without characters that XML does not allow.
fn model_name(scene: &Scene) -> String {
    let illegal = |c: char| c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}');
    let title = scene.title.replace(illegal, " ");
    match title.trim() {
        "" => "mooring".to_string(),
        title => title.to_string(),
    }
}

/// Name of the library: the title of the scene as a C identifier, so that FMUs of scenes with different titles have different library names.
fn model_identifier(scene: &Scene) -> String {
    let mut identifier = IDENTIFIER.to_string();
    let title = scene.title.to_lowercase();
    let words = title.split(|c: char| !c.is_ascii_alphanumeric());
    for word in words.filter(|word| !word.is_empty()) {
        let room = IDENTIFIER.len() + TITLE_MAX - identifier.len();
        if room < 2 {
            break;
        }
        identifier.push('_');
        identifier.push_str(&word[..word.len().min(room - 1)]);
    }
    identifier
}

/// Returns whether a name follows the standard's structured naming convention without quotes.
fn is_structured(name: &str) -> bool {
    name.split('.').all(|part| {
        let stem = part
            .split_once('[')
            .filter(|(_, index)| {
                index
                    .strip_suffix(']')
                    .is_some_and(|digits| digits.bytes().all(|b| b.is_ascii_digit()))
            })
            .map_or(part, |(stem, _)| stem);
        let mut characters = stem.chars();
        characters
            .next()
            .is_some_and(|c| c == '_' || c.is_ascii_alphabetic())
            && characters.all(|c| c == '_' || c.is_ascii_alphanumeric())
    })
}

fn write_co_simulation(xml: &mut Xml, scene: &Scene, version: FmiVersion) -> io::Result<()> {
    let identifier = model_identifier(scene);
    let (derivatives, order) = match scene.output.derivatives {
        true => ("true", "1"),
        false => ("false", "0"),
    };
    let attributes: &[(&str, &str)] = match version {
        FmiVersion::Two => &[
            ("modelIdentifier", &identifier),
            ("needsExecutionTool", "false"),
            ("canHandleVariableCommunicationStepSize", "true"),
            ("canInterpolateInputs", "true"),
            ("maxOutputDerivativeOrder", order),
            ("canRunAsynchronuously", "false"),
            ("canBeInstantiatedOnlyOncePerProcess", "false"),
            ("canNotUseMemoryManagementFunctions", "true"),
            ("canGetAndSetFMUstate", "true"),
            ("canSerializeFMUstate", "true"),
            ("providesDirectionalDerivative", derivatives),
        ],
        FmiVersion::Three => &[
            ("modelIdentifier", &identifier),
            ("needsExecutionTool", "false"),
            ("canBeInstantiatedOnlyOncePerProcess", "false"),
            ("canGetAndSetFMUState", "true"),
            ("canSerializeFMUState", "true"),
            ("providesDirectionalDerivatives", derivatives),
            ("canHandleVariableCommunicationStepSize", "true"),
            ("maxOutputDerivativeOrder", order),
            ("providesIntermediateUpdate", "true"),
            ("mightReturnEarlyFromDoStep", "false"),
            ("canReturnEarlyAfterIntermediateUpdate", "true"),
            ("hasEventMode", "false"),
        ],
    };
    let adjoint = scene.output.derivatives && version == FmiVersion::Three;
    let adjoint: &[_] = match adjoint {
        true => &[("providesAdjointDerivatives", "true")],
        false => &[],
    };
    empty(xml, "CoSimulation", &[attributes, adjoint].concat())
}

/// Units of the variables that have one, without repetition.
pub(super) fn units<'v>(variables: impl IntoIterator<Item = &'v Variable>) -> Vec<Unit> {
    let mut units = Vec::new();
    for variable in variables.into_iter().filter(|variable| has_unit(variable)) {
        if !units.contains(&variable.unit) {
            units.push(variable.unit);
        }
    }
    units
}

fn write_units(xml: &mut Xml, interface: &Interface, version: FmiVersion) -> io::Result<()> {
    let mut units = units(interface.variables());
    if version == FmiVersion::Three {
        units.retain(|unit| *unit != Unit::SECOND);
        units.insert(0, Unit::SECOND); // unit of the independent variable
    }
    within(xml, "UnitDefinitions", &[], |xml| {
        units.iter().try_for_each(|unit| write_unit(xml, unit))
    })
}

fn write_unit(xml: &mut Xml, unit: &Unit) -> io::Result<()> {
    within(xml, "Unit", &[("name", unit.name)], |xml| {
        empty(xml, "BaseUnit", &texts(&unit.exponents()))?;
        if *unit != Unit::RADIAN {
            return Ok(());
        }
        let factor = number(180.0 / std::f64::consts::PI);
        empty(xml, "DisplayUnit", &[("name", "deg"), ("factor", &factor)])
    })
}

fn write_variables(xml: &mut Xml, interface: &Interface, version: FmiVersion) -> io::Result<()> {
    for (index, variable) in interface.variables().iter().enumerate() {
        match version {
            FmiVersion::Two => write_variable2(xml, variable, index)?,
            FmiVersion::Three => write_variable3(xml, variable, index)?,
        }
    }
    if version == FmiVersion::Two {
        return Ok(());
    }
    let reference = time_reference(interface).to_string();
    let time = [
        ("name", "time"),
        ("valueReference", reference.as_str()),
        ("description", "time"),
        ("causality", "independent"),
        ("variability", "continuous"),
        ("unit", Unit::SECOND.name),
    ];
    empty(xml, "Float64", &time)
}

/// Value reference of the independent variable in FMI 3.0, after those of all other variables.
pub fn time_reference(interface: &Interface) -> u32 {
    Interface::reference(interface.variables().len())
}

/// Attributes of the variable element itself in both versions.
fn common_attributes(variable: &Variable, index: usize) -> Vec<(&'static str, String)> {
    let causality = match variable.causality {
        Causality::Input => "input",
        Causality::Output => "output",
        Causality::CalculatedParameter => "calculatedParameter",
        Causality::Parameter => "parameter",
    };
    let variability = match variable.variability {
        Variability::Fixed => "fixed",
        Variability::Discrete => "discrete",
        Variability::Continuous => "continuous",
    };
    let initial = match variable.causality {
        Causality::Input => None,
        Causality::Output | Causality::CalculatedParameter => Some("calculated"),
        Causality::Parameter => Some("exact"),
    };
    let mut attributes = vec![
        ("name", variable.name.clone()),
        ("valueReference", Interface::reference(index).to_string()),
        ("description", variable.description.clone()),
        ("causality", causality.to_string()),
        ("variability", variability.to_string()),
    ];
    attributes.extend(initial.map(|initial| ("initial", initial.to_string())));
    attributes
}

fn has_unit(variable: &Variable) -> bool {
    variable.kind == Kind::Float64
}

fn value_attributes(variable: &Variable) -> Vec<(&'static str, String)> {
    let mut attributes = Vec::new();
    if has_unit(variable) {
        attributes.push(("unit", variable.unit.name.to_string()));
        if variable.unit == Unit::RADIAN {
            attributes.push(("displayUnit", "deg".to_string()));
        }
    }
    let text = |value: f64| match variable.kind {
        Kind::Float64 => number(value),
        Kind::Int32 => format!("{value:.0}"),
        Kind::Boolean => (value != 0.0).to_string(),
    };
    for (key, limit) in ["min", "max"].into_iter().zip(variable.range) {
        attributes.extend(limit.map(|limit| (key, text(limit))));
    }
    let start = |start| vec![text(start); variable.size()].join(" ");
    attributes.extend(variable.start.map(|value| ("start", start(value))));
    attributes
}

/// Typical magnitude of a parameter: that of its value in the scene. The standard takes 1 for the others.
fn nominal(variable: &Variable) -> Option<f64> {
    let is_real = variable.causality == Causality::Parameter && variable.kind == Kind::Float64;
    let magnitude = variable.start?.abs();
    (is_real && magnitude > 0.0).then_some(magnitude)
}

fn write_variable2(xml: &mut Xml, variable: &Variable, index: usize) -> io::Result<()> {
    let common = common_attributes(variable, index);
    let mut value = value_attributes(variable);
    // not in FMI 3.0: the crate fmi 0.8 refuses descriptions with it
    value.extend(nominal(variable).map(|nominal| ("nominal", number(nominal))));
    let element = match variable.kind {
        Kind::Float64 => "Real",
        Kind::Int32 => "Integer",
        Kind::Boolean => "Boolean",
    };
    within(xml, "ScalarVariable", &texts(&common), |xml| {
        empty(xml, element, &texts(&value))
    })
}

/// Returns whether a host may access the variable within a communication step.
fn has_intermediate_values(variable: &Variable) -> bool {
    let is_in_time = matches!(variable.causality, Causality::Input | Causality::Output);
    is_in_time && variable.variability == Variability::Continuous
}

fn write_variable3(xml: &mut Xml, variable: &Variable, index: usize) -> io::Result<()> {
    let mut attributes = common_attributes(variable, index);
    if has_intermediate_values(variable) {
        attributes.push(("intermediateUpdate", "true".to_string()));
    }
    attributes.extend(value_attributes(variable));
    let element = match variable.kind {
        Kind::Float64 => "Float64",
        Kind::Int32 => "Int32",
        Kind::Boolean => "Boolean",
    };
    match variable.dimension {
        None => empty(xml, element, &texts(&attributes)),
        Some(length) => within(xml, element, &texts(&attributes), |xml| {
            empty(xml, "Dimension", &[("start", &length.to_string())])
        }),
    }
}

fn write_structure(
    xml: &mut Xml,
    interface: &Interface,
    version: FmiVersion,
    derivatives: bool,
) -> io::Result<()> {
    let of = |causalities: &'static [Causality]| {
        interface
            .variables()
            .iter()
            .enumerate()
            .filter(move |(_, variable)| causalities.contains(&variable.causality))
    };
    // without derivatives, outputs change only with a step
    let outputs = of(&[Causality::Output]).map(|(index, variable)| match derivatives {
        true => (index, interface.motions_of(variable)),
        false => (index, Vec::new()),
    });
    let initial = of(&[Causality::Output, Causality::CalculatedParameter])
        .map(|(index, variable)| (index, variable.initial_dependencies.clone()));
    match version {
        FmiVersion::Two => {
            within(xml, "Outputs", &[], |xml| {
                write_unknowns(xml, ["Unknown", "index"], outputs)
            })?;
            within(xml, "InitialUnknowns", &[], |xml| {
                write_unknowns(xml, ["Unknown", "index"], initial)
            })
        }
        FmiVersion::Three => {
            write_unknowns(xml, ["Output", "valueReference"], outputs)?;
            write_unknowns(xml, ["InitialUnknown", "valueReference"], initial)
        }
    }
}

/// Writes variables, by their index in the table, with the value references on which they depend.
fn write_unknowns(
    xml: &mut Xml,
    [element, key]: [&str; 2],
    mut unknowns: impl Iterator<Item = (usize, Vec<u32>)>,
) -> io::Result<()> {
    unknowns.try_for_each(|(index, dependencies)| {
        let dependencies: Vec<String> = dependencies.iter().map(u32::to_string).collect();
        let reference = Interface::reference(index).to_string();
        let attributes = [
            (key, reference.as_str()),
            ("dependencies", &dependencies.join(" ")),
        ];
        empty(xml, element, &attributes)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_with_other_characters_is_not_structured() {
        for name in ["line1.tension_b", "_a.b[12]", "gravity"] {
            assert!(is_structured(name), "{name}");
        }
        for name in ["line 1.x", "1.x", "ø.x", "a..b", "a.b[x]", "a-b.x", ""] {
            assert!(!is_structured(name), "{name}");
        }
    }

    #[test]
    fn a_radian_is_shown_in_degrees() {
        let mut writer = Xml::new(Vec::new());
        write_unit(&mut writer, &Unit::RADIAN).unwrap();
        assert_eq!(
            String::from_utf8(writer.into_inner()).unwrap(),
            "<Unit name=\"rad\"><BaseUnit rad=\"1\"/><DisplayUnit name=\"deg\" factor=\"57.29577951308232\"/></Unit>"
        );
    }

    #[test]
    fn a_title_with_control_characters_stays_legal_xml() {
        let mut scene = Scene::from_toml(include_str!("../../scenes/demo.toml")).unwrap();
        scene.title = "a\u{1}<b>".into();
        assert_eq!(model_name(&scene), "a <b>");
    }

    #[test]
    fn the_library_has_the_title_in_its_name_as_a_name_of_c() {
        let mut scene = Scene::from_toml(include_str!("../../scenes/demo.toml")).unwrap();
        for (title, identifier) in [
            ("OC3 line, 40 elements", "moorline_oc3_line_40_elements"),
            ("  3 Ø-lines! ", "moorline_3_lines"),
            ("", "moorline"),
            (
                "abcdefghij abcdefghij abcdefghij abcdefghij",
                "moorline_abcdefghij_abcdefghij_abcdefghij_abcdef",
            ),
        ] {
            scene.title = title.into();
            assert_eq!(model_identifier(&scene), identifier);
        }
    }

    #[test]
    fn author_and_date_are_described_and_leave_the_token() {
        let text = include_str!("../../scenes/demo.toml");
        let scene = Scene::from_toml(text).unwrap();
        let plain = Description::new(text, &scene, FmiVersion::Two).unwrap();
        let (author, date) = (
            Some("A & B".to_string()),
            Some("2026-01-01T00:00:00Z".to_string()),
        );
        let stamp = Stamp { author, date };
        let stamped = Description::stamped(text, &scene, FmiVersion::Two, &stamp).unwrap();
        assert_eq!(stamped.token, plain.token);
        let wanted = "author=\"A &amp; B\" generationDateAndTime=\"2026-01-01T00:00:00Z\"";
        assert!(stamped.xml.contains(wanted) && !plain.xml.contains("author"));
    }

    #[test]
    fn the_token_changes_with_description_and_scene() {
        let first = token("xml", "scene");
        assert_eq!(first.len(), 64);
        assert_ne!(first, token("xml2", "scene"));
        assert_ne!(first, token("xml", "scene2"));
        assert_ne!(token("ab", "c"), token("a", "bc"));
    }
}
