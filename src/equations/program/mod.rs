//! Equations compiled once: from the tree to a graph without repeats, from the graph to code over lanes of cells.
//!
//! A program reads a file of registers. The first are its *slots*: the time, the variables in the order of
//! [`System::variables`], then the *open* quantities, which the caller may set for each cell: the inputs of the system
//! and those parameters named when compiling. All other parameters are folded in as constants. Behind these stand the *delayed*
//! values of a system that looks back, which only single solves set (`ode::lookback`).

pub mod code;
mod delayed;
mod derivative;
mod elimination;
pub mod graph;
mod implicit;
mod initial;
mod past;
mod run;
mod simplify;

pub use delayed::DelayedValue;
pub use elimination::Elimination;
pub use initial::initial_values;
pub use past::Past;
pub use run::{Lanes, run, run_wide};

use std::hash::{Hash, Hasher};
use std::sync::Arc;

use crate::equations::tree::{Binary, Expr, QuantityId, Role, System};
use code::{Code, Constants};
use graph::{Graph, NodeId};

/// Cells side by side in a block of a population.
pub const LANES: usize = 16;

/// A system of equations ready to run.
#[derive(Debug, Clone)]
pub struct Program {
    /// Name of the system, for messages.
    pub name: String,
    /// The variables.
    pub variables: Vec<QuantityId>,
    /// The quantities set from outside.
    pub open: Vec<QuantityId>,
    /// Identifiers of all quantities, for messages.
    pub names: Vec<String>,
    /// Values of all quantities at the start.
    pub initial: Vec<f64>,
    /// Of each variable, the size that its absolute tolerance is meant for; see [`Self::with`].
    pub sizes: Vec<f64>,
    /// The rates of change of the variables.
    pub rates: Code,
    /// Rates, then their derivatives by time, then the entries of [`Self::pattern`].
    pub linear: Code,
    /// Whether the rates do not depend on time.
    pub timeless: bool,
    /// Whether the rates never read the clock, not even for a switch: at the same state and open values they are the same.
    pub rates_stand_still: bool,
    /// A number that programs with other rates, slots, constants or registers do not share.
    pub mark: u64,
    /// Row and column of the Jacobian's entries that are not always zero, row after row.
    pub pattern: Vec<(u32, u32)>,
    /// How implicit steps solve with them where that is cheaper than with whole matrices.
    pub elimination: Option<Elimination>,
    /// All quantities.
    pub observe: Code,
    /// The quantities that a search finds, which may find none.
    pub searched: Vec<QuantityId>,
    /// One code for each further group of expressions.
    pub further: Vec<Code>,
    /// The values of earlier times that the codes use, inner ones before those around them.
    pub delays: Vec<DelayedValue>,
    /// The equations themselves, where they look back: what was before the start is worked out from them.
    pub system: Option<Arc<System>>,
    /// When the system starts.
    pub start: f64,
    /// The constants behind the slots.
    constants: Vec<f64>,
    /// Registers that every code of the program fits in.
    registers: usize,
}

impl Program {
    /// Compiles a system for populations: it starts at time 0 and only its inputs are open.
    ///
    /// # Errors
    /// As [`Self::with`].
    pub fn new(system: &System) -> Result<Self, Vec<String>> {
        Self::with(system, 0.0, &[], &[])
    }

    /// Compiles a system that starts at a time, with some parameters open and further groups of expressions beside its
    /// rates. A variable that a defined quantity divides by the size of a compartment (an amount by a volume) has that
    /// size, when it is below 1, and all others 1: so the absolute tolerance holds for concentrations.
    ///
    /// # Errors
    /// The identifiers along a circle of definitions or initial values.
    pub fn with(system: &System, start: f64, open: &[QuantityId], further: &[Vec<Expr>]) -> Result<Self, Vec<String>> {
        let initial = initial_values(system, start)?;
        let variables = system.variables();
        let is_open = |number: &QuantityId| match system.quantities[*number as usize].role {
            Role::Input => true,
            Role::Parameter => open.contains(number),
            _ => false,
        };
        let open: Vec<QuantityId> = (0..system.quantities.len() as QuantityId).filter(is_open).collect();
        let mut graph = Graph::default();
        let nodes = quantity_nodes(system, &mut graph, &variables, &open, &initial)?;
        let mut rates = rate_nodes(system, &mut graph, &variables, &nodes);
        let searched = searched(system);
        stop_without(&mut graph, &mut rates, &searched, &nodes);
        let (linear, pattern) = linear_nodes(&mut graph, &rates);
        let drifts = &linear[rates.len()..2 * rates.len()];
        let timeless = drifts.iter().all(|&drift| graph.value(drift) == Some(0.0));
        let further: Vec<Vec<NodeId>> = further
            .iter()
            .map(|group| group.iter().map(|expression| graph.expression(expression, &nodes)).collect())
            .collect();
        let mut constants = Constants::default();
        let slots = 1 + variables.len() + open.len() + 2 * graph.delayed.len();
        let looks =
            [&rates, &linear, &nodes].into_iter().chain(&further).map(|group| graph.delays(group)).collect::<Vec<_>>();
        let (rates, linear) = (graph.with_shared_divisors(&rates), graph.with_shared_divisors(&linear));
        for (graph, group) in [&rates, &linear] {
            constants.collect(graph, group);
        }
        let behind: Vec<[NodeId; 2]> = graph.delayed.iter().map(|delayed| [delayed.delay, delayed.value]).collect();
        for group in
            [&nodes[..]].into_iter().chain(further.iter().map(Vec::as_slice)).chain(behind.iter().map(|b| &b[..]))
        {
            constants.collect(&graph, group);
        }
        let code = |graph: &Graph, roots: &[NodeId]| Code::of(graph, roots, slots, &constants);
        let mut all = vec![code(&rates.0, &rates.1), code(&linear.0, &linear.1), code(&graph, &nodes)];
        all.extend(further.iter().map(|group| code(&graph, group)));
        all.iter_mut().zip(looks).for_each(|(code, delays)| code.delays = delays);
        let delays = delayed::values(&graph, system, start, |roots| code(&graph, roots));
        let behind = delays.iter().flat_map(|delayed| [&delayed.delay, &delayed.value]);
        let registers = all.iter().chain(behind).map(|code| code.registers).max().unwrap_or(0);
        let further = all.split_off(3);
        let elimination = Elimination::of(variables.len(), &pattern);
        let [rates, linear, observe] = all.try_into().expect("three codes are left");
        Ok(Self {
            name: system.name.clone(),
            variables,
            open,
            names: system.quantities.iter().map(|quantity| quantity.id.clone()).collect(),
            sizes: sizes(system, &initial),
            initial,
            rates_stand_still: !rates.reads(0),
            searched,
            mark: mark(&rates, &constants.values, slots, registers),
            rates,
            linear,
            timeless,
            elimination,
            pattern,
            observe,
            further,
            system: (!delays.is_empty()).then(|| Arc::new(system.clone())),
            delays,
            start,
            registers,
            constants: constants.values,
        })
    }

    /// How many variables there are.
    pub fn size(&self) -> usize {
        self.variables.len()
    }

    /// The register of the first open quantity.
    pub fn first_open(&self) -> usize {
        1 + self.variables.len()
    }

    /// The register of the first constant.
    fn first_constant(&self) -> usize {
        self.first_open() + self.open.len() + 2 * self.delays.len()
    }

    /// The index of an open quantity among the open ones.
    pub fn open_index(&self, quantity: QuantityId) -> Option<usize> {
        self.open.iter().position(|&open| open == quantity)
    }

    /// The index of a variable in the state.
    pub fn variable_index(&self, quantity: QuantityId) -> Option<usize> {
        self.variables.iter().position(|&variable| variable == quantity)
    }

    /// Sets the registers of the constants.
    #[inline(always)]
    pub fn set_constants<const L: usize>(&self, file: &mut [Lanes<L>]) {
        let first = self.first_constant();
        for (register, &value) in file[first..].iter_mut().zip(&self.constants) {
            *register = [value; L];
        }
    }

    /// Makes a file of registers long enough, and sets its constants.
    pub fn suit<const L: usize>(&self, file: &mut Vec<Lanes<L>>) {
        file.resize(self.registers(), [0.0; L]);
        self.set_constants(file);
    }

    /// How many registers every code of the program fits in.
    fn registers(&self) -> usize {
        self.registers.max(self.first_constant() + self.constants.len())
    }

    /// A file of registers with the constants set and the slots at their initial values.
    pub fn file<const L: usize>(&self) -> Vec<Lanes<L>> {
        let mut file = vec![[0.0; L]; self.registers()];
        let slots = self.variables.iter().chain(&self.open).map(|&quantity| self.initial[quantity as usize]);
        for (register, value) in file[1..].iter_mut().zip(slots) {
            *register = [value; L];
        }
        self.set_constants(&mut file);
        file
    }
}

/// The quantities that equations determine which are not solved for.
fn searched(system: &System) -> Vec<QuantityId> {
    let is_searched = |number: &QuantityId| {
        matches!(&system.quantities[*number as usize].role, Role::Defined { rule: Expr::Root(..) })
    };
    (0..system.quantities.len() as QuantityId).filter(is_searched).collect()
}

/// Lets the first rate be no number where a search finds nothing that no rate needs: a course ends where its equations have no
/// solution, also one that only links and columns look at.
fn stop_without(graph: &mut Graph, rates: &mut [NodeId], searched: &[QuantityId], nodes: &[NodeId]) {
    let needed = graph.needed(rates);
    let nothing = graph.constant(f64::NAN);
    let Some(first) = rates.first_mut() else { return };
    for node in searched.iter().map(|quantity| nodes[*quantity as usize]).filter(|node| !needed[*node as usize]) {
        // What is no number differs from itself.
        let is_found = graph.binary(Binary::Eq, node, node);
        *first = graph.select(is_found, *first, nothing);
    }
}

/// A number made of the rates' operations, the constants and the numbers of slots and registers.
fn mark(rates: &Code, constants: &[f64], slots: usize, registers: usize) -> u64 {
    let mut hasher = std::hash::DefaultHasher::new();
    (rates, slots, registers).hash(&mut hasher);
    constants.iter().for_each(|constant| constant.to_bits().hash(&mut hasher));
    hasher.finish()
}

/// The sizes of all variables, in order.
fn sizes(system: &System, initial: &[f64]) -> Vec<f64> {
    let mut sizes = vec![1.0_f64; initial.len()];
    for quantity in &system.quantities {
        let Role::Defined { rule: Expr::Binary(Binary::Div, amount, volume) } = &quantity.role else { continue };
        if let (Expr::Quantity(amount), Expr::Quantity(volume)) = (amount.as_ref(), volume.as_ref()) {
            let volume = initial[*volume as usize];
            if volume > 0.0 && volume < sizes[*amount as usize] {
                sizes[*amount as usize] = volume;
            }
        }
    }
    system.variables().into_iter().map(|variable| sizes[variable as usize]).collect()
}

fn quantity_nodes(
    system: &System,
    graph: &mut Graph,
    variables: &[QuantityId],
    open: &[QuantityId],
    initial: &[f64],
) -> Result<Vec<NodeId>, Vec<String>> {
    // Slots first, so that their nodes have the smallest numbers.
    graph.slot(0);
    graph.has_history = !system.history.is_empty();
    graph.first_delayed = 1 + (variables.len() + open.len()) as u32;
    let mut nodes = vec![NodeId::MAX; system.quantities.len()];
    for (index, &quantity) in variables.iter().chain(open).enumerate() {
        nodes[quantity as usize] = graph.slot(1 + index as u32);
    }
    for (number, quantity) in system.quantities.iter().enumerate() {
        if matches!(quantity.role, Role::Parameter) && nodes[number] == NodeId::MAX {
            nodes[number] = graph.constant(initial[number]);
        }
    }
    for number in system.definition_order()? {
        if let Role::Defined { rule } = &system.quantities[number as usize].role {
            nodes[number as usize] = graph.expression(rule, &nodes);
        }
    }
    Ok(nodes)
}

fn rate_nodes(system: &System, graph: &mut Graph, variables: &[QuantityId], nodes: &[NodeId]) -> Vec<NodeId> {
    let rate = |&quantity: &QuantityId| match &system.quantities[quantity as usize].role {
        Role::Variable { rate } => graph.expression(rate, nodes),
        _ => unreachable!("only variables are in the state"),
    };
    variables.iter().map(rate).collect()
}

/// Rates, derivatives by time, and the Jacobian's entries with their positions.
fn linear_nodes(graph: &mut Graph, rates: &[NodeId]) -> (Vec<NodeId>, Vec<(u32, u32)>) {
    let mut nodes = rates.to_vec();
    nodes.extend(rates.iter().map(|&rate| graph.derivative(rate, 0)).collect::<Vec<_>>());
    let mut pattern = Vec::new();
    for (row, &rate) in rates.iter().enumerate() {
        for column in graph.slots(&[rate]).into_iter().filter(|slot| (1..=rates.len() as u32).contains(slot)) {
            let entry = graph.derivative(rate, column);
            if graph.value(entry) != Some(0.0) {
                pattern.push((row as u32, column - 1));
                nodes.push(entry);
            }
        }
    }
    (nodes, pattern)
}
