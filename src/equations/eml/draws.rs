//! Starts that are drawn at random: `uniform(a, b)`, `normal(mean, deviation)` and `lognormal(median, deviation)` in the `initial` of variables.

use super::build::{Builder, Use};
use super::declare::tell;
use super::document::Level;
use super::random_words::{DRAWS, is_draw};
use super::xml::Element;
use crate::equations::expression::{Node, NodeKind, Trouble, Unit, is_constant, parse};
use crate::equations::tree::{Binary, Draw, Expr, Quantity, QuantityId, Role};

impl Builder<'_, '_> {
    /// The start of a variable, which may be drawn.
    pub(super) fn start_of(&mut self, element: &Element, id: &str) -> Option<Expr> {
        let text = element.attribute("initial")?.clone();
        let (mut node, troubles) = parse(&text.text);
        if !troubles.is_empty() || !node.calls().iter().any(|(name, _)| is_draw(name, &self.known.scope)) {
            return self.value(element, "initial", Use::Start, id);
        }
        if !matches!(self.known.level, Level::Scene | Level::Cell) {
            let message = "starts are drawn for systems of the scene and of cells only".to_owned();
            let help = "draw it in a system of the cells and link it here, or use noise";
            tell(self.context, &text, &Trouble::new(message, node.at.clone()).label("drawn").help(help));
            return None;
        }
        let bare = is_constant(&node);
        let first = self.draws.len();
        if let Err(trouble) = self.replace(&mut node, id) {
            tell(self.context, &text, &trouble);
            return None;
        }
        let mut scope = self.scope(Use::Start).clone();
        for (draw, name) in &self.draws[first..] {
            scope.quantities.insert(name.clone(), draw.quantity);
        }
        match scope.resolve(&node) {
            Ok(expr) => {
                let own = self.unit_of(id);
                let what = format!("`initial` of `{id}`");
                if !bare {
                    self.check_units(&text, &node, own.as_ref().map(|unit| (unit, what.as_str())));
                }
                Some(expr)
            }
            Err(more) => {
                more.iter().for_each(|trouble| tell(self.context, &text, trouble));
                None
            }
        }
    }

    /// Puts what is drawn in the stead of calls: of a + (b − a) u, m + s n and m exp(s n).
    fn replace(&mut self, node: &mut Node, variable: &str) -> Result<(), Trouble> {
        let at = node.at.clone();
        let new = |kind: NodeKind| Node { kind, at: at.clone() };
        let of_both = |function: Binary, a: Node, b: Node| new(NodeKind::Binary(function, Box::new(a), Box::new(b)));
        match &mut node.kind {
            NodeKind::Number(..) | NodeKind::Name(_) | NodeKind::Unread => {}
            NodeKind::Minus(a) | NodeKind::Not(a) => self.replace(a, variable)?,
            NodeKind::Binary(_, a, b) => {
                self.replace(a, variable)?;
                self.replace(b, variable)?;
            }
            NodeKind::Call(name, location, arguments) => {
                arguments.iter_mut().try_for_each(|argument| self.replace(argument, variable))?;
                let drawn = DRAWS.iter().find(|(known, _)| known == name && is_draw(name, &self.known.scope));
                let Some((known, needs)) = drawn else { return Ok(()) };
                let [a, b] = &arguments[..] else {
                    let message = format!("`{name}` takes 2 arguments and has {}", arguments.len());
                    return Err(Trouble::new(message, location.clone())
                        .label("2 arguments")
                        .help(format!("give {needs}")));
                };
                let is_bare = |node: &Node, value: f64| node.kind == NodeKind::Number(value, None);
                let is_standard = *known != "lognormal" && is_bare(a, 0.0) && is_bare(b, 1.0);
                let (a, b) = (a.clone(), b.clone());
                let number = new(NodeKind::Name(self.draw(variable, *known != "uniform")));
                *node = match *known {
                    _ if is_standard => number,
                    "uniform" => {
                        of_both(Binary::Add, a.clone(), of_both(Binary::Mul, of_both(Binary::Sub, b, a), number))
                    }
                    "normal" => of_both(Binary::Add, a, of_both(Binary::Mul, b, number)),
                    _ => {
                        let power = of_both(Binary::Mul, b, number);
                        of_both(Binary::Mul, a, new(NodeKind::Call("exp".into(), at.clone(), vec![power])))
                    }
                };
            }
        }
        Ok(())
    }

    /// One more number that is drawn for a variable; its name is a call that draws it, with blanks so that no two are alike.
    fn draw(&mut self, variable: &str, is_normal: bool) -> String {
        let number = self.draws.len();
        let blanks = " ".repeat(1 + number);
        let name = format!("{}(0,{blanks}1)", if is_normal { "normal" } else { "uniform" });
        let element = self.draws.iter().filter(|(draw, _)| draw.variable == variable).count() as u32;
        let quantity = (self.known.quantities.len() + self.known.given.len() + number) as QuantityId;
        self.known.units.insert(name.clone(), Unit::plain());
        self.draws.push((Draw { quantity, variable: variable.to_owned(), element, is_normal }, name.clone()));
        name
    }

    /// The quantities that are drawn, behind all others: in their middle until they are.
    pub(super) fn drawn_quantities(&self) -> impl Iterator<Item = Quantity> {
        self.draws.iter().map(|(draw, name)| Quantity {
            id: name.clone(),
            name: String::new(),
            role: Role::Parameter,
            initial: Expr::Number(if draw.is_normal { 0.0 } else { 0.5 }),
            unit: "1".to_owned(),
        })
    }
}
