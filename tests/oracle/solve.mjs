// Solves EPANET input files with the EPANET engine and writes what the comparison needs.
//
//   node solve.mjs OUTPUT_FOLDER FILE.inp ...
//
// Per file: OUTPUT_FOLDER/FILE.json with every hydraulic step at accuracy 1e-5, in the file's own units, and the
// time the engine takes for one solution from a cold start.
import { InitHydOption, LinkProperty, NodeProperty, Option, Project, Workspace } from "epanet-js";
import fs from "node:fs";
import path from "node:path";

const ACCURACY = 1e-5;
const ITERATIONS = 0;  // EN_ITERATIONS, the first analysis statistic
const NODE_COUNT = 0, LINK_COUNT = 2;
const WARM_UP_RUNS = 300;
const TIMED_RUNS = 200;

const numbers = (count, value) => Array.from({ length: count }, (_, i) => value(i + 1));

function readStep(model, time, nodes, links) {
  return {
    time,
    iterations: model.getStatistic(ITERATIONS),
    heads: numbers(nodes, (i) => model.getNodeValue(i, NodeProperty.Head)),
    demands: numbers(nodes, (i) => model.getNodeValue(i, NodeProperty.Demand)),
    flows: numbers(links, (i) => model.getLinkValue(i, LinkProperty.Flow)),
    open: numbers(links, (i) => model.getLinkValue(i, LinkProperty.Status)),
  };
}

function runPeriod(model, nodes, links) {
  const steps = [];
  model.openH();
  model.initH(InitHydOption.InitFlow);
  do {
    steps.push(readStep(model, model.runH(), nodes, links));
  } while (model.nextH() > 0);
  model.closeH();
  return steps;
}

function solveFirstStep(model, times) {
  for (let i = 0; i < times; ++i) {
    model.initH(InitHydOption.InitFlow);
    model.runH();
  }
}

function timeFirstStep(model) {
  model.openH();
  solveFirstStep(model, WARM_UP_RUNS);  // until the virtual machine has compiled what it will
  const begin = process.hrtime.bigint();
  solveFirstStep(model, TIMED_RUNS);
  const end = process.hrtime.bigint();
  model.closeH();
  return Number(end - begin) / 1e3 / TIMED_RUNS;
}

function solve(workspace, file) {
  const model = new Project(workspace);
  workspace.writeFile("network.inp", fs.readFileSync(file));
  try {
    model.open("network.inp", "network.rpt", "network.out");
  } catch (error) {
    throw new Error(`${file}: ${error.message}\n${workspace.readFile("network.rpt")}`);
  }
  model.setOption(Option.Accuracy, ACCURACY);
  const nodes = model.getCount(NODE_COUNT), links = model.getCount(LINK_COUNT);
  const result = {
    engine: workspace.version,
    nodes: numbers(nodes, (i) => model.getNodeId(i)),
    links: numbers(links, (i) => model.getLinkId(i)),
    steps: runPeriod(model, nodes, links),
  };
  result.first_step_us = timeFirstStep(model);
  model.close();
  return result;
}

const [folder, ...files] = process.argv.slice(2);
const workspace = new Workspace({ version: "2.3.5" });
await workspace.loadModule();
console.warn = () => {};  // "negative pressures" is a result, not news
fs.mkdirSync(folder, { recursive: true });
for (const file of files) {
  const name = path.basename(file, ".inp") + ".json";
  fs.writeFileSync(path.join(folder, name), JSON.stringify(solve(workspace, file)));
}
