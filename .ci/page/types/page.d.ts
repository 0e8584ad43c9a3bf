// What the scripts of the page find beside them: uPlot, which a script of its own puts there.
declare const uPlot: any;
