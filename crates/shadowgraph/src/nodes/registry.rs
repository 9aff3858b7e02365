//! Kinds of nodes by name.

use shadowgraph_core::did_you_mean;

use super::built_in;
use super::kind::NodeKind;
use super::node::Node;
use super::port::{Port, PortKind, Presence};
use crate::error::Error;

/// Kinds of nodes by name.
#[derive(Clone, Debug)]
pub struct Nodes(Vec<NodeKind>);

impl Nodes {
    /// Returns the built-in kinds.
    pub fn built_in() -> Self {
        Self(built_in::kinds().to_vec())
    }

    /// Adds a kind.
    ///
    /// # Errors
    /// [`Error::NodeKind`] for a duplicate name, and for invalid ports or settings.
    pub fn register<N: Node>(&mut self) -> Result<(), Error> {
        let kind = NodeKind::new::<N>();
        self.check(&kind).map_err(|reason| Error::NodeKind { kind: kind.name, reason })?;
        self.0.push(kind);
        Ok(())
    }

    fn check(&self, kind: &NodeKind) -> Result<(), String> {
        if self.get(kind.name).is_some() {
            return Err("a kind of this name is already registered".into());
        }
        let ports = |ports: &[Port]| ports.iter().map(|port| port.name).collect();
        unique(ports(kind.inputs), "input")?;
        unique(ports(kind.outputs), "output")?;
        unique(kind.settings.iter().map(|setting| setting.name).collect(), "setting")?;
        if let Some(error) =
            kind.settings.iter().find_map(|setting| setting.check(&setting.default_value()).err())
        {
            return Err(format!("invalid default: {error}"));
        }
        let has_placeholder = |port: &&Port| matches!(port.presence, Presence::Placeholder(_));
        match kind.inputs.iter().filter(has_placeholder).find(|port| port.kind != PortKind::Texture) {
            None => Ok(()),
            Some(port) => {
                Err(format!("only textures have placeholders, and `{}` is a {}", port.name, port.kind.name()))
            }
        }
    }

    /// Returns the kinds in order of registration.
    pub fn kinds(&self) -> &[NodeKind] {
        &self.0
    }

    /// Returns the kind of a name.
    pub fn get(&self, name: &str) -> Option<&NodeKind> {
        self.0.iter().find(|kind| kind.name == name)
    }

    /// Describes a kind: its ports and settings, with ranges, units and defaults.
    ///
    /// # Errors
    /// [`Error::UnknownNodeKind`] with the closest name.
    pub fn describe(&self, name: &str) -> Result<String, Error> {
        let kind = self.get(name).ok_or_else(|| Error::UnknownNodeKind {
            name: name.into(),
            hint: did_you_mean(name, self.0.iter().map(|kind| kind.name)),
        })?;
        Ok(kind.describe())
    }
}

fn unique(names: Vec<&'static str>, what: &str) -> Result<(), String> {
    let duplicate = names.iter().enumerate().find(|(index, name)| names[..*index].contains(name));
    duplicate.map_or(Ok(()), |(_, name)| Err(format!("duplicate {what} `{name}`")))
}

#[cfg(test)]
impl Nodes {
    /// Checks each kind against the others.
    pub(super) fn check_all(&self) -> Result<(), String> {
        self.0.iter().try_for_each(|kind| {
            let others = self.0.iter().filter(|other| other.name != kind.name).copied().collect();
            Self(others).check(kind).map_err(|reason| format!("{}: {reason}", kind.name))
        })
    }
}
