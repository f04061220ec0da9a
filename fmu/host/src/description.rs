//! Data of modelDescription.xml that a host needs: version, token, library name, variables.

use quick_xml::XmlVersion;
use quick_xml::events::{BytesStart, Event};

use crate::{FmiVersion, HostError};

/// Role of a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Causality {
    /// Set before the simulation.
    Parameter,
    /// Computed from parameters.
    CalculatedParameter,
    /// Set by the host.
    Input,
    /// Read by the host.
    Output,
    /// Time.
    Independent,
    /// Anything else.
    Local,
}

/// Type of a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VariableType {
    /// `Real` or `Float64`.
    Real,
    /// `Integer` or `Int32`.
    Integer,
    /// `Boolean`.
    Boolean,
    /// Any other type.
    Other,
}

/// A variable of an FMU.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// Name.
    pub name: String,
    /// Value reference.
    pub reference: u32,
    /// Role.
    pub causality: Causality,
    /// Type.
    pub kind: VariableType,
    /// Number of values [-]: 1 for a scalar.
    pub size: usize,
    /// Unit, as written in the description.
    pub unit: Option<String>,
}

/// Contents of an FMU's description that a host needs.
#[derive(Debug, Clone, PartialEq)]
pub struct Description {
    /// Version of the interface.
    pub version: FmiVersion,
    /// Name of the model.
    pub model_name: String,
    /// `guid` or `instantiationToken`.
    pub token: String,
    /// Name of the library without extension.
    pub model_identifier: String,
    /// Variables in the order of the description.
    pub variables: Vec<Variable>,
    /// Start of the default experiment [s].
    pub start_time: f64,
    /// End of the default experiment [s].
    pub stop_time: Option<f64>,
    /// Communication step of the default experiment [s].
    pub step_size: Option<f64>,
}

impl Description {
    /// Reads the text of a modelDescription.xml.
    ///
    /// # Errors
    /// Text that is not XML, another FMI version, or a description without co-simulation.
    pub fn from_xml(text: &str) -> Result<Description, HostError> {
        let mut reader = quick_xml::Reader::from_str(text);
        let mut description = Description {
            version: FmiVersion::Two,
            model_name: String::new(),
            token: String::new(),
            model_identifier: String::new(),
            variables: Vec::new(),
            start_time: 0.0,
            stop_time: None,
            step_size: None,
        };
        loop {
            match reader.read_event().map_err(broken)? {
                Event::Start(tag) | Event::Empty(tag) => description.read_tag(&tag)?,
                Event::Eof => break,
                _ => {}
            }
        }
        if description.model_identifier.is_empty() {
            return Err(HostError::Description("it offers no co-simulation".into()));
        }
        Ok(description)
    }

    fn read_tag(&mut self, tag: &BytesStart<'_>) -> Result<(), HostError> {
        match tag.name().as_ref() {
            "fmiModelDescription" => self.read_root(tag)?,
            "CoSimulation" => self.model_identifier = required(tag, "modelIdentifier")?,
            "DefaultExperiment" => {
                self.start_time = number(tag, "startTime")?.unwrap_or(0.0);
                self.stop_time = number(tag, "stopTime")?;
                self.step_size = number(tag, "stepSize")?;
            }
            "ScalarVariable" => self.push_variable(tag, VariableType::Other)?,
            "Real" | "Integer" | "Boolean" | "Enumeration" | "String" if self.version == FmiVersion::Two => {
                if let Some(variable) = self.variables.last_mut() {
                    variable.kind = variable_type(tag.name().as_ref());
                    variable.unit = attribute(tag, "unit")?;
                }
            }
            name @ ("Float64" | "Int32" | "Boolean") if self.version == FmiVersion::Three => {
                self.push_variable(tag, variable_type(name))?;
            }
            "Dimension" => {
                let size = number(tag, "start")?.unwrap_or(1.0);
                if let Some(variable) = self.variables.last_mut() {
                    variable.size *= size as usize;
                }
            }
            _ => {}
        }
        Ok(())
    }

    fn read_root(&mut self, tag: &BytesStart<'_>) -> Result<(), HostError> {
        let version = required(tag, "fmiVersion")?;
        self.model_name = required(tag, "modelName")?;
        (self.version, self.token) = if version == "2.0" {
            (FmiVersion::Two, required(tag, "guid")?)
        } else if version.starts_with("3.0") {
            (FmiVersion::Three, required(tag, "instantiationToken")?)
        } else {
            return Err(HostError::Description(format!(
                "FMI version {version} is neither 2.0 nor 3.0"
            )));
        };
        Ok(())
    }

    fn push_variable(&mut self, tag: &BytesStart<'_>, kind: VariableType) -> Result<(), HostError> {
        let reference = required(tag, "valueReference")?;
        self.variables.push(Variable {
            name: required(tag, "name")?,
            reference: reference
                .parse()
                .map_err(|_| HostError::Description(format!("valueReference {reference}")))?,
            causality: match attribute(tag, "causality")?.as_deref() {
                Some("parameter") => Causality::Parameter,
                Some("calculatedParameter") => Causality::CalculatedParameter,
                Some("input") => Causality::Input,
                Some("output") => Causality::Output,
                Some("independent") => Causality::Independent,
                _ => Causality::Local,
            },
            kind,
            size: 1,
            unit: attribute(tag, "unit")?,
        });
        Ok(())
    }
}

fn variable_type(tag: &str) -> VariableType {
    match tag {
        "Real" | "Float64" => VariableType::Real,
        "Integer" | "Int32" => VariableType::Integer,
        "Boolean" => VariableType::Boolean,
        _ => VariableType::Other,
    }
}

pub(crate) fn broken(error: impl std::fmt::Display) -> HostError {
    HostError::Description(error.to_string())
}

pub(crate) fn attribute(tag: &BytesStart<'_>, name: &str) -> Result<Option<String>, HostError> {
    let Some(attribute) = tag.try_get_attribute(name).map_err(broken)? else {
        return Ok(None);
    };
    let value = attribute
        .normalized_value(XmlVersion::Implicit1_0)
        .map_err(broken)?;
    Ok(Some(value.into_owned()))
}

pub(crate) fn required(tag: &BytesStart<'_>, name: &str) -> Result<String, HostError> {
    attribute(tag, name)?
        .ok_or_else(|| HostError::Description(format!("{} has no attribute {name}", tag.name().as_ref())))
}

pub(crate) fn number(tag: &BytesStart<'_>, name: &str) -> Result<Option<f64>, HostError> {
    attribute(tag, name)?
        .map(|text| {
            text.parse()
                .map_err(|_| HostError::Description(format!("{name} \"{text}\" is not a number")))
        })
        .transpose()
}
