//! Style sheets, `style` and presentation attributes, as far as they say what is drawn.

use crate::drawing::Source;
use roxmltree::{Document, Node};
use simplecss::{
    AttributeOperator, DeclarationTokenizer, Element, PseudoClass, StyleSheet,
};

/// All style sheets in a document.
pub(super) fn sheet<'a>(document: &'a Document) -> StyleSheet<'a> {
    let mut sheet = StyleSheet::new();
    for node in document.descendants().filter(|n| n.tag_name().name() == "style") {
        let texts = node.children().filter_map(|child| child.text());
        texts.for_each(|text| sheet.parse_more(text));
    }
    sheet
}

/// What an element inherits or says itself.
#[derive(Debug, Clone, Default)]
pub(super) struct Style {
    /// The name of the layer or group that is labelled.
    label: String,
    stroke: Option<[u8; 3]>,
    fill: Option<[u8; 3]>,
    /// Colour of the stroke, if it is said here.
    pub(super) own_colour: Option<[u8; 3]>,
    /// `display` is none.
    pub(super) is_switched_off: bool,
    /// `visibility` is hidden.
    pub(super) is_hidden: bool,
}

impl Style {
    /// The style of an element inside one of this style.
    pub(super) fn within(&self, node: &Node, sheet: &StyleSheet) -> Self {
        let mut style = Self { own_colour: None, ..self.clone() };
        let label = node.attributes().find(|attribute| attribute.name() == "label");
        if let Some(label) = label.map(|label| label.value().trim()) {
            label.clone_into(&mut style.label);
        } else if let Some(id) = node.attribute("id").filter(|_| is_outermost(node)) {
            id.clone_into(&mut style.label);
        }
        for name in ["stroke", "fill", "display", "visibility"] {
            if let Some(value) = node.attribute(name) {
                style.set(name, value);
            }
        }
        for rule in
            sheet.rules.iter().filter(|rule| rule.selector.matches(&Styled(*node)))
        {
            rule.declarations.iter().for_each(|d| style.set(d.name, d.value));
        }
        for own in DeclarationTokenizer::from(node.attribute("style").unwrap_or("")) {
            style.set(own.name, own.value);
        }
        style
    }

    fn set(&mut self, name: &str, value: &str) {
        let value = value.trim();
        let colour = || {
            let colour: svgtypes::Color = value.parse().ok()?;
            Some([colour.red, colour.green, colour.blue])
        };
        match name {
            "stroke" => {
                self.own_colour = colour();
                self.stroke = self.own_colour;
            }
            "fill" => self.fill = colour(),
            "display" => self.is_switched_off = value == "none",
            "visibility" => self.is_hidden = ["hidden", "collapse"].contains(&value),
            _ => {}
        }
    }

    /// Layer and colour as the drawing has them.
    pub(super) fn source(&self) -> Source {
        Source { name: self.label.clone(), rgb: self.stroke.or(self.fill) }
    }
}

/// Whether an element is a group that programs without labels take for a layer.
fn is_outermost(node: &Node) -> bool {
    let parent = node.parent_element();
    node.tag_name().name() == "g"
        && parent.is_some_and(|parent| parent.tag_name().name() == "svg")
}

/// An element as selectors look at it.
struct Styled<'a, 'input>(Node<'a, 'input>);

impl Element for Styled<'_, '_> {
    fn parent_element(&self) -> Option<Self> {
        self.0.parent_element().map(Styled)
    }

    fn prev_sibling_element(&self) -> Option<Self> {
        self.0.prev_sibling_element().map(Styled)
    }

    fn has_local_name(&self, name: &str) -> bool {
        self.0.tag_name().name() == name
    }

    fn attribute_matches(&self, name: &str, operator: AttributeOperator<'_>) -> bool {
        self.0.attribute(name).is_some_and(|value| operator.matches(value))
    }

    fn pseudo_class_matches(&self, class: PseudoClass<'_>) -> bool {
        class == PseudoClass::FirstChild && self.prev_sibling_element().is_none()
    }
}
