// What the page was made with: recorded bodies and how many files they come from, the variables of the description by
// name, and of the live page the wheel itself.
import {$} from '#dom';

export const {bodies, sources, variables, live} = JSON.parse($('#data').textContent);
